#include "bench/library_functions.h"

#include <cmath>

namespace haptel::bench {
namespace {

using ir::Op;

// `use` gets the function itself, so that a loop over it has no choice inside.
template <typename Real, typename Use>
auto with_function(Op op, const Use& use)
{
    switch (op) {
    case Op::sin: return use([](Real a, Real) { return std::sin(a); });
    case Op::cos: return use([](Real a, Real) { return std::cos(a); });
    case Op::tan: return use([](Real a, Real) { return std::tan(a); });
    case Op::asin: return use([](Real a, Real) { return std::asin(a); });
    case Op::acos: return use([](Real a, Real) { return std::acos(a); });
    case Op::atan: return use([](Real a, Real) { return std::atan(a); });
    case Op::atan2: return use([](Real a, Real b) { return a == 0 && b == 0 ? Real(0) : std::atan2(a, b); });
    case Op::sinh: return use([](Real a, Real) { return std::sinh(a); });
    case Op::cosh: return use([](Real a, Real) { return std::cosh(a); });
    case Op::tanh: return use([](Real a, Real) { return std::tanh(a); });
    case Op::asinh: return use([](Real a, Real) { return std::asinh(a); });
    case Op::acosh: return use([](Real a, Real) { return std::acosh(a); });
    case Op::atanh: return use([](Real a, Real) { return std::atanh(a); });
    case Op::exp: return use([](Real a, Real) { return std::exp(a); });
    case Op::exp2: return use([](Real a, Real) { return std::exp2(a); });
    case Op::log: return use([](Real a, Real) { return std::log(a); });
    case Op::log2: return use([](Real a, Real) { return std::log2(a); });
    case Op::pow: return use([](Real a, Real b) { return std::pow(a, b); });
    default: return use([](Real a, Real) { return a; });
    }
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
