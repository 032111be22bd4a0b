#include "lang/ir/bounds/continuity.h"

#include "lang/ir/op_info.h"
#include "lang/math/spline.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

bool holds_zero_inside(const Interval& a)
{
    return a.minimum < 0 && a.maximum > 0;
}

bool overlap_inside(const Interval& a, const Interval& b)
{
    return a.minimum < b.maximum && b.minimum < a.maximum;
}

bool is_bounded(const Interval& a)
{
    return std::isfinite(a.minimum) && std::isfinite(a.maximum);
}

// Where a derivative has no bound the function is not even Lipschitz there; what is unbounded itself jumps.
Continuity by_bounds(std::span<const Interval> operands, uint32_t active, const Interval& result,
                     const Partials& partials)
{
    const bool from_bounded = std::all_of(operands.begin(), operands.end(), is_bounded);
    Continuity continuity = Continuity::smooth;
    for (size_t i = 0; i < operands.size(); ++i) {
        if (!(active >> i & 1)) continue;
        for (size_t k = 0; k < operands.size(); ++k)
            if (active >> k & 1 && from_bounded && !is_bounded(partials.second[i][k]))
                continuity = std::min(continuity, Continuity::c1);
        if (from_bounded && !is_bounded(partials.first[i])) continuity = std::min(continuity, Continuity::c0);
    }
    return from_bounded && !is_bounded(result) ? Continuity::jump : continuity;
}

} // namespace

Continuity continuity_of(Op op, std::span<const Interval> operands, uint32_t active, const Interval& result,
                         const Partials& partials)
{
    if (active == 0) return Continuity::smooth;
    const Interval& a = operands[0];
    const Interval& b = operands.size() > 1 ? operands[1] : a;
    if (op == Op::abs) return holds_zero_inside(a) ? Continuity::c0 : Continuity::smooth;
    if (op == Op::min || op == Op::max) return overlap_inside(a, b) ? Continuity::c0 : Continuity::smooth;
    if (op == Op::fract) return std::floor(a.minimum) == std::floor(a.maximum) ? Continuity::smooth : Continuity::jump;
    if (op == Op::mod) {
        const Interval cell = evaluate(Op::floor, std::vector{evaluate(Op::div, operands)});
        return cell.is_point() ? Continuity::smooth : Continuity::jump;
    }
    if (is_step(op)) return result.is_point() ? Continuity::smooth : Continuity::jump;
    if (is_length(op)) {
        const bool reaches_zero =
            std::all_of(operands.begin(), operands.end(), [](const Interval& part) { return part.contains(0); });
        return reaches_zero ? Continuity::c0 : Continuity::smooth;
    }
    if (op == Op::div && b.contains(0) && (active & 2)) return Continuity::jump;
    if (traits(op).shape == Shape::angle)
        return b.minimum <= 0 && a.contains(0) ? Continuity::jump : Continuity::smooth;
    if (op == Op::spline) { // cubic; what it depends on in which direction is not looked at
        const auto orders = static_cast<uint32_t>(operands[3].minimum);
        constexpr Continuity classes[] = {Continuity::c2, Continuity::c1, Continuity::c0, Continuity::jump};
        const uint32_t order = std::max(spline_order_along(orders, 0), spline_order_along(orders, 1));
        return result.is_point() || order > 3 ? Continuity::smooth
               : operands[3].is_point()       ? classes[order]
                                              : Continuity::jump;
    }
    // Choices, comparisons and integers can only change by a step.
    const OpInfo& info = op_info(op);
    if (info.result != 'r' || info.operands.find_first_not_of('r') != std::string_view::npos)
        return result.is_point() ? Continuity::smooth : Continuity::jump;
    return by_bounds(operands, active, result, partials);
}

} // namespace haptel::ir
