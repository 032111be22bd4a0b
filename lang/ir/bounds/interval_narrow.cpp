// What a condition that holds, or does not, says of the values that it compares.
#include "lang/ir/bounds/interval_evaluator.h"

#include <algorithm>

namespace haptel::ir {

// Shrinks what the condition compares to the values for which it is as `taken` says; false if there are none.
bool IntervalEvaluator::narrow(Frame& frame, Value condition, bool taken, std::vector<Narrowed>& undo)
{
    std::vector<std::pair<Value, bool>> open{{condition, taken}};
    while (!open.empty()) {
        auto [value, wanted] = open.back();
        open.pop_back();
        const Instruction* made = frame.makers[value.index];
        auto* operation = made ? std::get_if<Operation>(&made->kind) : nullptr;
        if (!operation) continue;
        if (operation->op == Op::lnot) open.emplace_back(made->operands[0], !wanted);
        if (operation->op == (wanted ? Op::land : Op::lor))
            for (Value part : made->operands) open.emplace_back(part, wanted);
        if (!narrow_comparison(frame, *made, wanted, undo)) return false;
    }
    return true;
}

bool IntervalEvaluator::narrow_comparison(Frame& frame, const Instruction& made, bool taken,
                                          std::vector<Narrowed>& undo)
{
    const Op op = std::get<Operation>(made.kind).op;
    const bool is_less = op == Op::lt || op == Op::ilt || op == Op::ult;
    const bool is_less_or_equal = op == Op::le || op == Op::ile || op == Op::ule;
    const bool is_equal = op == Op::eq || op == Op::ieq || op == Op::ueq;
    if (!is_less && !is_less_or_equal && !is_equal) return true;
    const Interval a = frame.values[made.operands[0].index], b = frame.values[made.operands[1].index];
    // A comparison with NaN is false, which then says nothing of the other operand.
    if (!taken && (is_equal || a.may_be_nan || b.may_be_nan)) return true;

    Interval narrow_a = a, narrow_b = b;
    if (taken) narrow_a.may_be_nan = narrow_b.may_be_nan = false;
    const bool a_is_below = taken, both = is_equal;
    if (a_is_below || both) {
        narrow_a.maximum = std::min(a.maximum, b.maximum);
        narrow_b.minimum = std::max(a.minimum, b.minimum);
    }
    if (!a_is_below || both) {
        narrow_a.minimum = std::max(a.minimum, b.minimum);
        narrow_b.maximum = std::min(a.maximum, b.maximum);
    }
    undo.push_back({made.operands[0], a});
    undo.push_back({made.operands[1], b});
    frame.values[made.operands[0].index] = narrow_a;
    frame.values[made.operands[1].index] = narrow_b;
    return !narrow_a.is_empty() && !narrow_b.is_empty();
}

} // namespace haptel::ir
