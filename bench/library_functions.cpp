#include "bench/library_functions.h"

#include "lang/ir/elementary_exact.h"

namespace haptel::bench {
namespace {

using ir::Op;

// `use` gets the function itself, so that a loop over it has no choice inside.
template <typename Real, typename Use>
auto with_function(Op op, const Use& use)
{
    switch (op) {
#define ELEMENTARY(name, ...)                                                                                          \
    case Op::name: return use([](Real a, Real) { return ir::exact::name(a); });
#define ELEMENTARY2(name, ...)                                                                                         \
    case Op::name: return use([](Real a, Real b) { return ir::exact::name(a, b); });
#define OP(name, ...)                                                                                                  \
    case Op::name: break;
#include "lang/ir/ops.def"
    }
    return use([](Real a, Real) { return a; });
}

template <typename Real>
Real value(Op op, Real a, Real b)
{
    return with_function<Real>(op, [&](auto function) { return function(a, b); });
}

template <typename Real>
void sum(Op op, const std::vector<std::vector<Real>>& operands, Real* sums)
{
    with_function<Real>(op, [&](auto function) {
        const size_t calls = operands.size();
        for (size_t i = 0; i < operands[0].size(); ++i) {
            sums[i] = function(operands[0][i], operands[1][i]);
            for (size_t k = 1; k < calls; ++k) sums[i] += function(operands[k][i], operands[(k + 1) % calls][i]);
        }
    });
}

} // namespace

double library_function(Op op, double a, double b)
{
    return value(op, a, b);
}

float library_function(Op op, float a, float b)
{
    return value(op, a, b);
}

void library_sums(Op op, const std::vector<std::vector<double>>& operands, double* sums)
{
    sum(op, operands, sums);
}

void library_sums(Op op, const std::vector<std::vector<float>>& operands, float* sums)
{
    sum(op, operands, sums);
}

} // namespace haptel::bench
