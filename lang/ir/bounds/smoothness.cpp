#include "lang/ir/bounds/smoothness.h"

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
Smoothness by_bounds(std::span<const Interval> operands, uint32_t active, const Interval& result,
                     const Partials& partials)
{
    const bool from_bounded = std::all_of(operands.begin(), operands.end(), is_bounded);
    Smoothness smoothness = Smoothness::smooth;
    for (size_t i = 0; i < operands.size(); ++i) {
        if (!(active >> i & 1)) continue;
        for (size_t k = 0; k < operands.size(); ++k)
            if (active >> k & 1 && from_bounded && !is_bounded(partials.second[i][k]))
                smoothness = std::min(smoothness, Smoothness::c1);
        if (from_bounded && !is_bounded(partials.first[i])) smoothness = std::min(smoothness, Smoothness::c0);
    }
    return from_bounded && !is_bounded(result) ? Smoothness::jump : smoothness;
}

} // namespace

Smoothness smoothness_of(Op op, std::span<const Interval> operands, uint32_t active, const Interval& result,
                         const Partials& partials)
{
    if (active == 0) return Smoothness::smooth;
    const Interval& a = operands[0];
    const Interval& b = operands.size() > 1 ? operands[1] : a;
    if (op == Op::abs) return holds_zero_inside(a) ? Smoothness::c0 : Smoothness::smooth;
    if (op == Op::min || op == Op::max) return overlap_inside(a, b) ? Smoothness::c0 : Smoothness::smooth;
    if (op == Op::fract) return std::floor(a.minimum) == std::floor(a.maximum) ? Smoothness::smooth : Smoothness::jump;
    if (op == Op::mod) {
        const Interval cell = evaluate(Op::floor, std::vector{evaluate(Op::div, operands)});
        return cell.is_point() ? Smoothness::smooth : Smoothness::jump;
    }
    if (is_step(op)) return result.is_point() ? Smoothness::smooth : Smoothness::jump;
    if (is_length(op)) {
        const bool reaches_zero =
            std::all_of(operands.begin(), operands.end(), [](const Interval& part) { return part.contains(0); });
        return reaches_zero ? Smoothness::c0 : Smoothness::smooth;
    }
    if (op == Op::div && b.contains(0) && (active & 2)) return Smoothness::jump;
    if (traits(op).shape == Shape::angle)
        return b.minimum <= 0 && a.contains(0) ? Smoothness::jump : Smoothness::smooth;
    if (op == Op::spline) { // cubic; what it depends on in which direction is not looked at
        const auto orders = static_cast<uint32_t>(operands[3].minimum);
        constexpr Smoothness classes[] = {Smoothness::c2, Smoothness::c1, Smoothness::c0, Smoothness::jump};
        const uint32_t order = std::max(spline_order_along(orders, 0), spline_order_along(orders, 1));
        return result.is_point() || order > 3 ? Smoothness::smooth
               : operands[3].is_point()       ? classes[order]
                                              : Smoothness::jump;
    }
    // Choices, comparisons and integers can only change by a step.
    const OpInfo& info = op_info(op);
    if (info.result != 'r' || info.operands.find_first_not_of('r') != std::string_view::npos)
        return result.is_point() ? Smoothness::smooth : Smoothness::jump;
    return by_bounds(operands, active, result, partials);
}

} // namespace haptel::ir
