#include "lang/ir/bounds/partials.h"

#include "lang/ir/builder.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/op_info.h"

#include <algorithm>

namespace haptel::ir {

namespace {

// Whether the only place in these operands where a partial is infinite is one for which its rule says 0, and the
// partial is a number for every normal double beside it.
bool is_guarded(Op op, std::span<const Interval> operands)
{
    const auto is_finite = [](const Interval& operand) { return operand.is_finite(); };
    return traits(op).is_guarded && std::all_of(operands.begin(), operands.end(), is_finite) &&
           evaluate(op, operands).is_finite();
}

} // namespace

PartialRules::Line PartialRules::differentiated(Op op, uint32_t active)
{
    const uint32_t arity = op_info(op).arity;
    std::vector<uint32_t> directions; // the active operands
    for (uint32_t i = 0; i < arity; ++i)
        if (active >> i & 1) directions.push_back(i);

    Module module;
    Builder builder(module, "operation");
    std::vector<Value> operands;
    for (uint32_t i = 0; i < arity; ++i) operands.push_back(builder.parameter(Type::real));
    const uint32_t itself = builder.finish(std::vector<Value>{builder.operation(op, operands)});
    Seeds seeds(arity, std::vector<Seed>(directions.size(), Seed::none));
    for (size_t d = 0; d < directions.size(); ++d) seeds[directions[d]][d] = Seed::unit;
    Differentiator differentiator(module);
    const Derivative once = differentiator.derivative(itself, seeds);
    const Derivative twice = differentiator.derivative(once.function, seeds);

    const Function& function = module.functions[twice.function];
    Line line;
    std::vector<uint32_t> place(function.value_types.size(), 0);
    for (uint32_t i = 0; i < arity; ++i) place[function.parameters[i].index] = i;
    for (const Instruction& made : function.body.instructions) {
        place[made.results[0].index] = arity + static_cast<uint32_t>(line.steps.size());
        Step& step = line.steps.emplace_back();
        if (auto* real = std::get_if<RealConstant>(&made.kind)) step.constant = {real->value, real->value};
        if (auto* truth = std::get_if<WordConstant>(&made.kind))
            step.constant = {truth->bits ? 1.0 : 0.0, truth->bits ? 1.0 : 0.0};
        if (auto* operation = std::get_if<Operation>(&made.kind)) {
            step.op = operation->op;
            for (Value operand : made.operands) step.operands.push_back(place[operand.index]);
        }
    }
    // Results: value, its tangents; then the tangents of the value once more, and those of each tangent.
    const std::vector<Value>& results = function.body.yields;
    size_t next = 1;
    std::vector<uint32_t> tangent_of; // the operand that each tangent is with respect to
    for (size_t d = 0; d < directions.size(); ++d)
        if (once.exists[0][d]) {
            line.first.emplace_back(directions[d], place[results[next++].index]);
            tangent_of.push_back(directions[d]);
        }
    next += static_cast<size_t>(std::count(twice.exists[0].begin(), twice.exists[0].end(), true));
    for (size_t t = 0; t < tangent_of.size(); ++t)
        for (size_t d = 0; d < directions.size(); ++d)
            if (twice.exists[t + 1][d])
                line.second.emplace_back(tangent_of[t], directions[d], place[results[next++].index]);
    return line;
}

Partials PartialRules::of(Op op, std::span<const Interval> operands, uint32_t active)
{
    auto known = lines.find({op, active});
    if (known == lines.end()) known = lines.emplace(std::pair{op, active}, differentiated(op, active)).first;
    const Line& line = known->second;

    values.assign(operands.begin(), operands.end());
    for (const Step& step : line.steps) {
        Interval parts[operands_max];
        for (size_t k = 0; k < step.operands.size(); ++k) parts[k] = values[step.operands[k]];
        values.push_back(step.operands.empty() ? step.constant : evaluate(step.op, {parts, step.operands.size()}));
    }
    // Where a partial is not a number no entry returns a gradient: what counts is all the other values it may have.
    const auto bounded = [&](uint32_t where) {
        const Interval& found = values[where];
        return found.is_empty() ? Interval{0, 0} : Interval{found.minimum, found.maximum};
    };
    Partials partials{};
    for (const auto& [operand, where] : line.first) {
        partials.first[operand] = bounded(where);
        partials.may_fault[operand] = !values[where].is_finite() && !is_guarded(op, operands);
    }
    for (const auto& [i, k, where] : line.second) partials.second[i][k] = bounded(where);
    return partials;
}

} // namespace haptel::ir
