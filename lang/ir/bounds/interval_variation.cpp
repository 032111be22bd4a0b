// How the result of one operation varies with the point: its derivatives, its class and its crossings of seams; and
// where finite operands make a value, or a derivative, that is not finite.
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/op_info.h"
#include "lang/math/spline.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

bool overlap_inside(const Interval& a, const Interval& b)
{
    return a.minimum < b.maximum && b.minimum < a.maximum;
}

bool is_of_reals(const OpInfo& info)
{
    return info.result == 'r' && info.operands.find_first_not_of('r') == std::string_view::npos;
}

// How smooth an operation is over these operands, of which those whose bit is set in `active` depend on the point. A
// kink or jump that the intervals exclude does not count, nor does one that only the other operands can reach.
Continuity continuity_of(Op op, std::span<const Interval> operands, uint32_t active, const Interval& result,
                         const Partials& partials)
{
    const auto unless = [](bool is_smooth, Continuity rough) { return is_smooth ? Continuity::smooth : rough; };
    if (active == 0) return Continuity::smooth;
    const Interval& a = operands[0];
    const Interval& b = operands.size() > 1 ? operands[1] : a;
    const auto holds_zero = [](const Interval& part) { return part.contains(0); };
    if (op == Op::abs) return unless(!overlap_inside(a, {0, 0}), Continuity::c0);
    if (op == Op::min || op == Op::max) return unless(!overlap_inside(a, b), Continuity::c0);
    if (op == Op::fract) return unless(std::floor(a.minimum) == std::floor(a.maximum), Continuity::jump);
    if (op == Op::mod) {
        const Interval quotient[] = {evaluate(Op::div, operands)};
        return unless(evaluate(Op::floor, quotient).is_point(), Continuity::jump);
    }
    if (is_length(op)) return unless(!std::ranges::all_of(operands, holds_zero), Continuity::c0);
    if (op == Op::div && holds_zero(b) && (active & 2)) return Continuity::jump;
    if (traits(op).shape == Shape::angle) return unless(b.minimum > 0 || !holds_zero(a), Continuity::jump);
    if (op == Op::spline && operands[3].is_point()) { // cubic; what it depends on in which direction is not looked at
        const auto orders = static_cast<uint32_t>(operands[3].minimum);
        constexpr Continuity classes[] = {Continuity::c2, Continuity::c1, Continuity::c0, Continuity::jump};
        const uint32_t order = std::max(spline_order_along(orders, 0), spline_order_along(orders, 1));
        return unless(result.is_point() || order > 3, classes[std::min(order, 3u)]);
    }
    // Choices, comparisons and integers can only change by a step.
    if (is_step(op) || !is_of_reals(op_info(op))) return unless(result.is_point(), Continuity::jump);

    // Where a derivative has no bound the function is not even Lipschitz there; what is unbounded itself jumps.
    if (!std::ranges::all_of(operands, is_bounded)) return Continuity::smooth;
    if (!is_bounded(result)) return Continuity::jump;
    Continuity continuity = Continuity::smooth;
    for (size_t i = 0; i < operands.size(); ++i) {
        if (!(active >> i & 1)) continue;
        if (!is_bounded(partials.first[i])) return Continuity::c0;
        for (size_t k = 0; k < operands.size(); ++k)
            if (active >> k & 1 && !is_bounded(partials.second[i][k])) continuity = Continuity::c1;
    }
    return continuity;
}

// What is chosen of the last two operands: the one that can be, or either.
Variation chosen(const IntervalEvaluator::Frame& frame, const Instruction& made, bool first, bool second)
{
    const size_t count = made.operands.size();
    const Variation& a = frame.variations[made.operands[count - 2].index];
    const Variation& b = frame.variations[made.operands[count - 1].index];
    Variation either = first && second ? merge(a, b) : first ? a : b;
    either.number = ValueNumbers::none;
    return either;
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

Partials IntervalEvaluator::spline_partials(std::span<const Interval> operands) const
{
    const auto derivative = [&](uint32_t by_x, uint32_t by_y) {
        const double step = spline_order(by_x, by_y), order = operands[3].minimum + step;
        const Interval deeper[] = {operands[0], operands[1], operands[2], {order, operands[3].maximum + step}};
        const Interval found = of_image(Op::spline, deeper);
        return found.is_empty() ? Interval{0, 0} : Interval{found.minimum, found.maximum};
    };
    Partials partials{};
    partials.first[1] = derivative(1, 0);
    partials.first[2] = derivative(0, 1);
    partials.second[1][1] = derivative(2, 0);
    partials.second[1][2] = partials.second[2][1] = derivative(1, 1);
    partials.second[2][2] = derivative(0, 2);
    const bool are_finite = operands[1].is_finite() && operands[2].is_finite();
    for (size_t i : {1, 2}) partials.may_fault[i] = !are_finite || std::isinf(partials.first[i].maximum);
    return partials;
}

Variation IntervalEvaluator::variation_of(Frame& frame, const Instruction& made, Op op,
                                          std::span<const Interval> operands, const Interval& result)
{
    const std::span<Variation> variations{operand_variations.data(), operands.size()};
    uint32_t moving = 0, differentiated = 0; // the code does not know what these intervals know, and takes part in more
    for (size_t i = 0; i < operands.size(); ++i) {
        variations[i] = frame.variations[made.operands[i].index];
        variations[i].has_tangent = frame.tangents.any(made.operands[i]);
        const bool stays_between_jumps = variations[i].slope == 0 && variations[i].curvature == 0;
        if (variations[i].is_active && !stays_between_jumps) moving |= 1u << i;
        if (variations[i].is_active || variations[i].has_tangent) differentiated |= 1u << i;
    }
    if (differentiated == 0) return {};
    left -= std::min<uint64_t>(left, 3); // what it costs more than a value alone
    const Interval& a = operands[0];
    if (op == Op::select) {
        Variation either = chosen(frame, made, a.contains(1), a.contains(0));
        if (a.contains(1) && a.contains(0)) jump_with(variations[0], made.span, either);
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
        variation = chosen(frame, made, a_can || !b_can, b_can);
        if (a.may_be_nan || b.may_be_nan) // which counts as a tie: the mean of both
            variation.may_fault |= variations[0].may_fault || variations[1].may_fault;
    } else {
        if (op == Op::spline)
            partials = spline_partials(operands);
        else if (is_of_reals(op_info(op)))
            partials = rules.of(op, operands, result, differentiated, with_curvature);
        variation = chain(op, operands, variations, partials, with_curvature);
        const bool is_new = std::ranges::none_of(variations, &Variation::may_fault);
        const bool is_part = frame.structure.is_part_of_result[made.results[0].index];
        if (variation.may_fault && is_new && is_part && result.is_finite())
            note_fault(made, op, operands, Undefined::Why::derivative);
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
    const bool is_to_zero = (op == Op::min || op == Op::max) && std::ranges::any_of(operands, &Interval::is_zero);
    const bool at_zero = op == Op::abs || is_length(op) || is_to_zero;
    if (own == Continuity::c0 && was_smooth && at_zero) variation.kink = ++kinks, variation.kink_power = 1;
    return variation;
}

// Where finite operands make what is not, and not where that is passed on.
void IntervalEvaluator::note_fault(const Instruction& made, Op op, std::span<const Interval> operands,
                                   Undefined::Why why)
{
    if (std::ranges::all_of(operands, &Interval::is_finite)) note({op, why, operands[op == Op::div], made.span});
}

// Each place once; the library's is the call.
void IntervalEvaluator::note(const Undefined& place)
{
    if (!varying || is_trying || is_compared) return;
    const Span span = user.value_or(place.span);
    for (const Undefined& known : noted.undefined)
        if (known.op == place.op && known.span.file == span.file && known.span.begin == span.begin) return;
    noted.undefined.push_back({place.op, place.why, place.operand, span});
}

} // namespace haptel::ir
