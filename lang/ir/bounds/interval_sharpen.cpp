// What the operands of one operation say together, beyond their intervals.
#include "lang/ir/bounds/interval_evaluator.h"

#include <algorithm>

namespace haptel::ir {

// Whether it is `x == 0 ? a : y / x` of numbers.
bool IntervalEvaluator::is_guarded_division(const Frame& frame, const Instruction& made, Op op) const
{
    if (op != Op::select) return false;
    const Instruction *test = frame.makers[made.operands[0].index], *division = frame.makers[made.operands[2].index];
    const auto is = [](const Instruction* by, Op which) {
        auto* operation = by ? std::get_if<Operation>(&by->kind) : nullptr;
        return operation && operation->op == which;
    };
    if (!is(test, Op::eq) || !is(division, Op::div) || test->operands[0] != division->operands[1]) return false;
    const Interval& zero = frame.values[test->operands[1].index];
    const auto is_finite = [&](Value value) { return frame.values[value.index].is_finite(); };
    return zero.is_point() && zero.minimum == 0 && is_finite(division->operands[0]) && is_finite(division->operands[1]);
}

// What the operands say together: a square, a component of a unit vector, a division whose divisor was looked at.
Interval IntervalEvaluator::sharpened(const Frame& frame, const Instruction& made, Op op, const Interval& result) const
{
    Interval sharp = result;
    const auto maker = [&](size_t operand) { return frame.makers[made.operands[operand].index]; };
    const auto made_by = [&](const Instruction* by, Op which) {
        auto* operation = by ? std::get_if<Operation>(&by->kind) : nullptr;
        return operation && operation->op == which;
    };
    if (op == Op::sub && made_by(maker(1), Op::detach) && maker(1)->operands[0] == made.operands[0] &&
        frame.values[made.operands[0].index].is_finite())
        sharp = {0, 0}; // x - detach(x): a derivative, no value
    if (op == Op::mul && made.operands[0] == made.operands[1]) sharp.minimum = std::max(sharp.minimum, 0.0);
    if (op == Op::div) {
        const Instruction* divisor = maker(1);
        for (Op length : {Op::length2, Op::length3, Op::length4})
            if (made_by(divisor, length) && std::find(divisor->operands.begin(), divisor->operands.end(),
                                                      made.operands[0]) != divisor->operands.end())
                sharp = intersect(Interval{sharp.minimum, sharp.maximum, true}, Interval{-1, 1, sharp.may_be_nan});
    }
    if (is_guarded_division(frame, made, op)) sharp.may_be_nan = frame.values[made.operands[1].index].may_be_nan;
    return sharp;
}

} // namespace haptel::ir
