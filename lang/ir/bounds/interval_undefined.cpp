// What the evaluator notes where finite operands make a value, or a derivative, that is not finite.
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/op_info.h"

#include <algorithm>

namespace haptel::ir {

// Where finite operands make what is not, and not where that is passed on.
void IntervalEvaluator::note_undefined(const Instruction& made, Op op, std::span<const Interval> operands,
                                       const Interval& result)
{
    const OpInfo& info = op_info(op);
    const auto is_finite = [](const Interval& operand) { return operand.is_finite(); };
    if (info.result != 'r' || info.operands[0] != 'r' || is_trying || result.is_finite()) return;
    if (!std::all_of(operands.begin(), operands.end(), is_finite)) return;
    const Undefined::Why why = result.may_be_nan && op != Op::div ? Undefined::Why::domain
                               : holds_pole(op, operands)         ? Undefined::Why::pole
                                                                  : Undefined::Why::overflow;
    note({op, why, operands[op == Op::div ? 1 : 0], made.span});
}

// Likewise of the derivative.
void IntervalEvaluator::note_derivative(const Instruction& made, Op op, std::span<const Interval> operands,
                                        const Interval& result)
{
    const auto is_finite = [](const Interval& operand) { return operand.is_finite(); };
    if (is_trying || !result.is_finite() || !std::all_of(operands.begin(), operands.end(), is_finite)) return;
    note({op, Undefined::Why::derivative, operands[op == Op::div ? 1 : 0], made.span});
}

// Each place once; the library's is the call.
void IntervalEvaluator::note(const Undefined& found)
{
    if (is_compared) return;
    const Span span = user.value_or(found.span);
    for (const Undefined& known : undefined_operations)
        if (known.op == found.op && known.span.file == span.file && known.span.begin == span.begin) return;
    undefined_operations.push_back({found.op, found.why, found.operand, span});
}

} // namespace haptel::ir
