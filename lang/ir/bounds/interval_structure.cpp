// What a function's text says of its values beyond their intervals: which values are part of what it returns, and what
// the operands of one operation say together.
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

// Backward from what a function returns: which numbers become part of another. Those that are only compared, or made
// whole numbers of, may be infinite or NaN without a fault.
std::vector<bool> parts_of_results(const Function& function, const std::vector<const Instruction*>& makers)
{
    std::vector<bool> is_part(function.value_types.size(), false);
    std::vector<Value> open;
    const auto mark = [&](Value value) {
        if (function.type(value) != Type::real || is_part[value.index]) return;
        is_part[value.index] = true;
        open.push_back(value);
    };
    for (Value result : function.body.yields) mark(result);
    while (!open.empty()) {
        const Instruction* made = makers[open.back().index];
        open.pop_back();
        if (!made) continue;
        for (Value operand : made->operands) mark(operand);
        for (const Block& inner : blocks_of(*made))
            for (Value yield : inner.yields) mark(yield);
    }
    return is_part;
}

bool is_sum_or_product(Op op)
{
    return op == Op::add || op == Op::sub || op == Op::mul;
}

} // namespace

const IntervalEvaluator::Structure& IntervalEvaluator::structure_of(uint32_t index)
{
    Structure& known = structures[index];
    if (!known.makers.empty()) return known;
    const Function& function = module.functions[index];
    known.makers.resize(function.value_types.size() + 1);
    for_each_instruction(function.body, [&](const Instruction& made) {
        for (Value result : made.results) known.makers[result.index] = &made;
    });
    known.is_part_of_result = parts_of_results(function, known.makers);
    for_each_instruction(function.body, [&](const Instruction& made) {
        const std::optional<Op> op = op_of(&made);
        if (!op || !is_sum_or_product(*op)) return;
        if (auto polynomial = Polynomial::of(known.makers, made.results[0]))
            known.polynomials.emplace(made.results[0].index, std::move(*polynomial));
    });
    return known;
}

// Whether it is `x == 0 ? a : y / x` of numbers.
bool IntervalEvaluator::is_guarded_division(const Frame& frame, const Instruction& made, Op op)
{
    if (op != Op::select) return false;
    const Instruction *test = frame.makers[made.operands[0].index], *division = frame.makers[made.operands[2].index];
    if (op_of(test) != Op::eq || op_of(division) != Op::div || test->operands[0] != division->operands[1]) return false;
    const Interval& zero = frame.values[test->operands[1].index];
    const auto is_finite = [&](Value value) { return frame.values[value.index].is_finite(); };
    return zero.is_point() && zero.minimum == 0 && std::ranges::all_of(division->operands, is_finite);
}

// What the operands say together: a square, a component of a unit vector, a division whose divisor was looked at.
Interval IntervalEvaluator::sharpened(const Frame& frame, const Instruction& made, Op op, const Interval& result)
{
    Interval sharp = result;
    const Value a = made.operands[0];
    const Instruction* second = made.operands.size() > 1 ? frame.makers[made.operands[1].index] : nullptr;
    if (op == Op::sub && op_of(second) == Op::detach && second->operands[0] == a && frame.values[a.index].is_finite())
        sharp = {0, 0}; // x - detach(x): a derivative, no value
    if (const Polynomial* polynomial = is_sum_or_product(op) ? frame.structure.polynomial_of(made.results[0]) : nullptr)
        if (const auto range = polynomial->range(frame.values))
            sharp = {std::max(sharp.minimum, range->minimum), std::min(sharp.maximum, range->maximum),
                     sharp.may_be_nan};
    if (op == Op::mul && a == made.operands[1]) sharp.minimum = std::max(sharp.minimum, 0.0);
    const std::optional<Op> divisor = op == Op::div ? op_of(second) : std::nullopt;
    if (divisor && is_length(*divisor) && std::ranges::find(second->operands, a) != second->operands.end())
        sharp = intersect(sharp, Interval{-1, 1, true});
    if (is_guarded_division(frame, made, op)) sharp.may_be_nan = frame.values[made.operands[1].index].may_be_nan;
    return sharp;
}

} // namespace haptel::ir
