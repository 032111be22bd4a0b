#include "jit/codegen/precision.h"

#include "lang/ir/dataflow.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::jit {

namespace {

using ir::Growth;
using ir::Op;
using Sinks = PrecisionPlan::Sinks;

constexpr double unknown = std::numeric_limits<double>::infinity();
constexpr double large = 8; // f32 resolves what is smaller to 5e-7

// |result| of an operation on values of at most those sizes.
double bound_of(Op op, const std::vector<double>& of)
{
    const ir::Traits& row = ir::traits(op);
    switch (row.growth) {
    case Growth::range: return std::fmax(std::fabs(row.least), std::fabs(row.most));
    case Growth::sum: return of[0] + of[1];
    case Growth::product: return of[0] == 0 || of[1] == 0 ? 0 : of[0] * of[1];
    case Growth::first: return of[0];
    case Growth::largest: return std::fmax(of[of.size() - 2], of[of.size() - 1]);
    case Growth::last: return of.back();
    }
    return unknown;
}

Sinks result_sink(size_t result)
{
    return Sinks{1} << std::min<size_t>(result + 1, 63);
}

// One function, its callees known: sizes forwards, then sinks backwards.
class SinkAnalysis {
public:
    SinkAnalysis(const ir::Module& whole, const std::vector<PrecisionPlan::Summary>& known, const ir::Function& of)
        : module(whole)
        , callees(known)
        , function(of)
        , bounds(of.value_types.size(), unknown)
        , sinks(of.value_types.size())
    {
        measure(function.body);
        for (size_t i = 0; i < function.body.yields.size(); ++i) sink(function.body.yields[i], result_sink(i));
        ir::Dataflow(*this).backwards(function.body);
    }
    PrecisionPlan::Summary summary() { return {std::move(sinks), result_bounds()}; }

private:
    friend ir::Dataflow<SinkAnalysis>;
    const ir::Module& module;
    const std::vector<PrecisionPlan::Summary>& callees;
    const ir::Function& function;
    std::vector<double> bounds; // by value
    std::vector<Sinks> sinks;   // likewise

    std::vector<double> result_bounds() const
    {
        std::vector<double> of_results;
        for (size_t i = 0; i < function.body.yields.size(); ++i) {
            double bound = bounds[function.body.yields[i].index];
            if (i < function.facts.size() && function.facts[i].value_minimum && function.facts[i].value_maximum)
                bound = std::fmin(bound, std::fmax(std::fabs(*function.facts[i].value_minimum),
                                                   std::fabs(*function.facts[i].value_maximum)));
            of_results.push_back(bound);
        }
        return of_results;
    }

    // ---- sizes
    void measure(const ir::Block& block)
    {
        for (const ir::Instruction& made : block.instructions) {
            for (const ir::Block& inner : ir::blocks_of(made)) measure(inner);
            for (size_t i = 0; i < made.results.size(); ++i) bounds[made.results[i].index] = bound_of_result(made, i);
        }
    }
    double bound_of_result(const ir::Instruction& made, size_t i) const
    {
        if (const auto* constant = std::get_if<ir::RealConstant>(&made.kind)) return std::fabs(constant->value);
        if (const auto* call = std::get_if<ir::Call>(&made.kind)) return callees[call->function].result_bounds[i];
        if (const auto* choice = std::get_if<ir::If>(&made.kind))
            return std::fmax(bounds[choice->arms[0].yields[i].index], bounds[choice->arms[1].yields[i].index]);
        if (const auto* operation = std::get_if<ir::Operation>(&made.kind)) {
            std::vector<double> of;
            for (ir::Value operand : made.operands) of.push_back(bounds[operand.index]);
            return bound_of(operation->op, of);
        }
        double largest = 0;
        const auto* read = std::get_if<ir::ReadTable>(&made.kind);
        if (!read) return unknown; // what a loop carries, too
        for (double cell : module.tables[read->table].reals) largest = std::fmax(largest, std::fabs(cell));
        return largest;
    }

    // ---- sinks
    static constexpr uint32_t rounds_max = UINT32_MAX;

    bool sink(ir::Value value, Sinks to)
    {
        if (function.type(value) != ir::Type::real || bounds[value.index] <= large) return false;
        const bool is_new = (to & ~sinks[value.index]) != 0;
        sinks[value.index] |= to;
        return is_new;
    }
    bool flow(ir::Value from, ir::Value to) { return sink(to, sinks[from.index]); }
    void steer(ir::Value, ir::Value) {}
    void assume(ir::Value) {}
    void visit(const ir::Instruction& made)
    {
        if (const auto* operation = std::get_if<ir::Operation>(&made.kind)) {
            for (ir::Value operand : made.operands) {
                if (function.type(made.results[0]) == ir::Type::real) flow(made.results[0], operand);
                if (ir::traits(operation->op).reduces) sink(operand, 1);
            }
        } else if (const auto* call = std::get_if<ir::Call>(&made.kind)) {
            const ir::Function& callee = module.functions[call->function];
            for (size_t i = 0; i < made.operands.size(); ++i) {
                const Sinks inside = callees[call->function].sinks[callee.parameters[i].index];
                sink(made.operands[i], inside & 1);
                for (size_t j = 0; j < made.results.size(); ++j)
                    if (inside & result_sink(j)) flow(made.results[j], made.operands[i]);
            }
        }
    }
};

} // namespace

PrecisionPlan::PrecisionPlan(const ir::Module& of, Precision wanted) : module(of), precision(wanted)
{
    if (precision != Precision::mixed) return;
    functions.reserve(module.functions.size());
    for (const ir::Function& function : module.functions)
        functions.push_back(SinkAnalysis(module, functions, function).summary());
}

std::vector<bool> PrecisionPlan::wide_values(uint32_t function, const std::vector<bool>& wide_results) const
{
    std::vector<bool> wide(module.functions[function].value_types.size(), precision == Precision::f64);
    if (precision != Precision::mixed) return wide;
    Sinks wanted = 1;
    for (size_t i = 0; i < wide_results.size(); ++i)
        if (wide_results[i]) wanted |= result_sink(i);
    const std::vector<Sinks>& sinks = functions[function].sinks;
    for (size_t i = 0; i < wide.size(); ++i) wide[i] = (sinks[i] & wanted) != 0;
    return wide;
}

} // namespace haptel::jit
