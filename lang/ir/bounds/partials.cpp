#include "lang/ir/bounds/partials.h"

#include "lang/ir/builder.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <optional>

namespace haptel::ir {

PartialRules::Rule PartialRules::differentiated(Op op, uint32_t active, bool with_second)
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
    std::optional<Derivative> twice;
    if (with_second) twice = differentiator.derivative(once.function, seeds);

    Rule rule{module.functions[(twice ? *twice : once).function], {}, {}};
    // Results: value, its tangents; then the tangents of the value once more, and those of each tangent.
    auto next = rule.line.body.yields.begin() + 1;
    for (size_t d = 0; d < directions.size(); ++d)
        if (once.exists[0][d]) rule.first.emplace_back(directions[d], *next++);
    if (!twice) return rule;
    next += std::ranges::count(twice->exists[0], true);
    for (size_t t = 0; t < rule.first.size(); ++t)
        for (size_t d = 0; d < directions.size(); ++d)
            if (twice->exists[t + 1][d]) rule.second.emplace_back(rule.first[t].first, directions[d], *next++);
    return rule;
}

Partials PartialRules::of(Op op, std::span<const Interval> operands, const Interval& result, uint32_t active,
                          bool with_second)
{
    const std::tuple key{op, active, with_second};
    auto known = rules.find(key);
    if (known == rules.end()) known = rules.emplace(key, differentiated(op, active, with_second)).first;
    const auto& [line, first, second] = known->second;

    values.resize(line.value_types.size());
    for (size_t i = 0; i < operands.size(); ++i) values[line.parameters[i].index] = operands[i];
    for (const Instruction& made : line.body.instructions) {
        Interval& value = values[made.results[0].index];
        if (auto* real = std::get_if<RealConstant>(&made.kind)) value = {real->value, real->value};
        if (auto* truth = std::get_if<WordConstant>(&made.kind)) value = exactly(Type::boolean, truth->bits);
        if (made.results[0] == line.body.yields[0]) {
            value = result; // of the operation itself
        } else if (auto* operation = std::get_if<Operation>(&made.kind)) {
            Interval parts[operands_max];
            for (size_t k = 0; k < made.operands.size(); ++k) parts[k] = values[made.operands[k].index];
            value = evaluate(operation->op, {parts, made.operands.size()});
        }
    }
    // The only place in these operands where a partial is infinite may be one for which its rule says 0, and the
    // partial a number for every normal double beside it.
    const auto is_guarded = [&] {
        return traits(op).is_guarded && std::ranges::all_of(operands, &Interval::is_finite) &&
               evaluate(op, operands).is_finite();
    };
    // Where a partial is not a number no entry returns a gradient: what counts is all the other values it may have.
    const auto bounded = [&](Value where) {
        const Interval& found = values[where.index];
        return found.is_empty() ? Interval{0, 0} : Interval{found.minimum, found.maximum};
    };
    Partials partials{};
    for (const auto& [operand, where] : first) {
        partials.first[operand] = bounded(where);
        partials.may_fault[operand] = !values[where.index].is_finite() && !is_guarded();
    }
    for (const auto& [i, k, where] : second) partials.second[i][k] = bounded(where);
    return partials;
}

} // namespace haptel::ir
