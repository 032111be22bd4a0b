// How the result of one operation varies with the point: its derivatives, its class and its crossings of seams.
#include "lang/ir/bounds/continuity.h"
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/op_info.h"

#include <algorithm>

namespace haptel::ir {
namespace {

// One of the two is 0, always.
bool is_zero_side(std::span<const Interval> operands)
{
    return std::any_of(operands.begin(), operands.end(),
                       [](const Interval& operand) { return operand.minimum == 0 && operand.maximum == 0; });
}

} // namespace

std::vector<Seams::Operand> IntervalEvaluator::seam_operands(const Frame& frame, std::span<const Value> values)
{
    std::vector<Seams::Operand> operands;
    for (Value value : values)
        operands.push_back(
            seams->operand(frame.variations[value.index], frame.values[value.index], frame.function.type(value)));
    return operands;
}

// Of `a` where only it can be chosen, of both where either can; `by`: what the choice depends on, if on the point.
Variation IntervalEvaluator::chosen(Frame& frame, const Instruction& made, bool first, bool second,
                                    const Variation* by) const
{
    const size_t count = made.operands.size();
    const Variation& a = frame.variations[made.operands[count - 2].index];
    const Variation& b = frame.variations[made.operands[count - 1].index];
    Results either{{}, {first && second ? merge(a, b) : first ? a : b}};
    if (by && first && second) roughen_all(either, *by, made.span);
    either.variations[0].number = ValueNumbers::none;
    return either.variations[0];
}

Variation IntervalEvaluator::variation_of(Frame& frame, const Instruction& made, Op op,
                                          std::span<const Interval> operands, const Interval& result)
{
    Variation variations[operands_max];
    uint32_t moving = 0, differentiated = 0; // the code does not know what these intervals know, and takes part in more
    for (size_t i = 0; i < operands.size(); ++i) {
        variations[i] = variation_at(frame, made.operands[i]);
        if (variations[i].is_active && !stays_between_jumps(variations[i])) moving |= 1u << i;
        if (variations[i].is_active || variations[i].has_tangent) differentiated |= 1u << i;
    }
    if (differentiated == 0) return {};
    left -= std::min<uint64_t>(left, 3); // what it costs more than a value alone
    const Interval& a = operands[0];
    if (op == Op::select) {
        Variation either = chosen(frame, made, a.contains(1), a.contains(0), &variations[0]);
        if (is_guarded_division(frame, made, op)) {
            either.may_fault = variations[1].may_fault;
            for (Value part : frame.makers[made.operands[2].index]->operands)
                either.may_fault |= frame.variations[part.index].may_fault;
        }
        return either;
    }

    Variation variation;
    Partials partials{};
    if (op == Op::min || op == Op::max) {
        const Interval& b = operands[1];
        const bool a_can = op == Op::min ? a.minimum <= b.maximum : a.maximum >= b.minimum;
        const bool b_can = op == Op::min ? b.minimum <= a.maximum : b.maximum >= a.minimum;
        variation = chosen(frame, made, a_can || !b_can, b_can, nullptr);
        if (a.may_be_nan || b.may_be_nan) // which counts as a tie: the mean of both
            variation.may_fault |= variations[0].may_fault || variations[1].may_fault;
    } else {
        const OpInfo& info = op_info(op);
        const bool of_reals = info.result == 'r' && info.operands.find_first_not_of('r') == std::string_view::npos;
        if (op == Op::spline)
            partials = spline_partials(operands);
        else if (of_reals)
            partials = rules.of(op, operands, differentiated);
        variation = chain(op, operands, {variations, operands.size()}, partials);
        const auto may_fault = [](const Variation& operand) { return operand.may_fault; };
        const bool is_new = std::none_of(variations, variations + operands.size(), may_fault);
        const bool is_part = frame.structure.is_part_of_result[made.results[0].index];
        if (variation.may_fault && is_new && is_part) note_derivative(made, op, operands, result);
    }
    if (!variation.is_active) return variation;
    if (op == Op::detach) { // the gradient that is returned is another function's, which may bend anyhow
        variation.curvature = infinity;
        variation.hessian.fill({-infinity, infinity});
    }
    Continuity own = continuity_of(op, operands, moving, result, partials);
    const bool was_smooth = variation.continuity == Continuity::smooth;
    const Cause cause{made.span, op};
    if (own != Continuity::smooth) variation.kink = 0;
    if (seams) {
        const std::vector<Seams::Operand> all = seam_operands(frame, made.operands);
        seams->cross(op, all, result, variation);
        const Cause outside = user ? Cause{*user, {}, true} : cause;
        if (own == Continuity::jump && seams->begin(op, all, result, outside, variation)) own = Continuity::smooth;
    }
    roughen(variation, own, cause);
    const bool at_zero = op == Op::abs || is_length(op) || ((op == Op::min || op == Op::max) && is_zero_side(operands));
    if (own == Continuity::c0 && was_smooth && at_zero) variation.kink = ++kinks, variation.kink_power = 1;
    return variation;
}

} // namespace haptel::ir
