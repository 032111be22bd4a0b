#include "lang/analyse.h"

#include "lang/ir/op_info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace haptel::lang {
namespace {

using ir::Input;
using ir::Op;

constexpr double infinity = std::numeric_limits<double>::infinity();

ir::BoundsBox box_of(const AnalysedCube& where)
{
    const auto [side_m, footprint_m, turn_per_m] = where;
    ir::BoundsBox box;
    const auto set = [&](Input first, size_t count, ir::Interval interval) {
        std::fill_n(box.input + static_cast<size_t>(first), count, interval);
    };
    set(Input::p_x, 3, {-side_m / 2, side_m / 2});
    set(Input::n_x, 3, {-1, 1});
    set(Input::uv_x, 2, {-infinity, infinity});
    set(Input::n_dp_00, 9, {-turn_per_m, turn_per_m});
    box.normal_turn_max_per_m = turn_per_m;
    set(Input::uv_dp_00, 6, {-infinity, infinity});
    set(Input::time, 1, {0, infinity});
    set(Input::center_x, 3, {0, 0});
    set(Input::extent_x, 3, {side_m, side_m});
    set(Input::footprint, 1, {footprint_m, footprint_m});
    return box;
}

ir::Interval range_of(const ir::Parameter& parameter, double value)
{
    if (parameter.type == ir::Type::boolean) return {0, 1};
    if (!std::isfinite(parameter.minimum)) return {value, value};
    return {std::min(parameter.minimum, value), std::max(parameter.maximum, value)};
}

// What to write instead of an operation that is rough.
std::string smooth_form(const ir::Cause& cause)
{
    if (cause.is_library) return "haptel info tells how smooth the library's functions are";
    if (!cause.op) return "blend the two with smoothstep() where they are to differ, or let them meet";
    switch (*cause.op) {
    case Op::abs: return "smoothabs(x, k) rounds the kink off";
    case Op::min: return "smoothmin(a, b, k) rounds the kink off";
    case Op::max: return "smoothmax(a, b, k) rounds the kink off";
    case Op::length2:
    case Op::length3:
    case Op::length4: return "a length has a tip where it is 0: use dot(x, x), or sqrt(dot(x, x) + k * k)";
    case Op::floor:
    case Op::ceil:
    case Op::trunc:
    case Op::round:
    case Op::sign: return "smoothstep() makes a ramp of the step";
    case Op::fract:
    case Op::mod: return "sinturn() and wave() repeat smoothly";
    case Op::sqrt:
    case Op::pow: return "its slope has no bound at 0: add a small constant to what it is of";
    case Op::div: return "keep the divisor away from 0";
    case Op::atan2: return "the angle jumps by a whole turn: use it inside sin() or cos()";
    default: return "blend with smoothstep(), smoothabs(), smoothmin() or smoothmax()";
    }
}

std::string what_of(const ir::Cause& cause)
{
    return cause.op           ? std::string(ir::op_info(*cause.op).name) + "()"
           : cause.is_library ? std::string("this call")
                              : std::string("this choice");
}

std::string shown(const ir::Interval& range)
{
    const auto end = [](double value) {
        if (!std::isfinite(value)) return std::string("unbounded");
        std::array<char, 32> text;
        std::snprintf(text.data(), text.size(), "%.3g", value);
        return std::string(text.data());
    };
    return end(range.minimum) + " .. " + end(range.maximum);
}

void report(const ir::Undefined& found, Diagnostics& diagnostics)
{
    if (found.op == Op::div) {
        diagnostics
            .warning(found.span, "division", "this may divide by zero: the divisor lies in " + shown(found.operand))
            .hint = "add a small constant, or keep it away from 0 with max(); where it is 0 the height counts as 0";
        return;
    }
    if (!found.op) {
        diagnostics.warning(found.span, "domain", "a constant here is not a finite number").hint =
            "a division by 0, or a function outside of where it is defined, was computed once and for all";
        return;
    }
    Diagnostic& said = diagnostics.warning(found.span, "domain",
                                           std::string(ir::op_info(*found.op).name) +
                                               "() may be not a number: its argument lies in " + shown(found.operand));
    said.hint = "keep it where the function is defined, with clamp(), max() or abs(); else the height counts as 0";
}

} // namespace

Analysis analyse(const Program& program, const ir::Texture& texture, std::span<const double> values,
                 std::span<const ir::SplineImage* const> images, const AnalysedCube& where, Diagnostics& diagnostics)
{
    ir::BoundsBox at_values = box_of(where);
    at_values.images.assign(images.begin(), images.end());
    ir::BoundsBox over_ranges = at_values;
    for (size_t i = 0; i < values.size(); ++i) {
        at_values.parameters.push_back({values[i], values[i]});
        over_ranges.parameters.push_back(range_of(texture.parameters[i], values[i]));
    }
    const Analysis found{ir::texture_bounds(program.module, texture, at_values),
                         ir::texture_bounds(program.module, texture, over_ranges)};

    for (const ir::Undefined& undefined : found.over_ranges.undefined) report(undefined, diagnostics);
    const ir::Cause& cause = found.at_values.cause;
    const auto is_same_place = [&](const ir::Undefined& undefined) {
        return undefined.span.file == cause.span.file && undefined.span.begin == cause.span.begin;
    };
    const std::vector<ir::Undefined>& said = found.over_ranges.undefined;
    if (std::any_of(said.begin(), said.end(), is_same_place)) return found;
    if (found.at_values.smoothness == ir::Smoothness::jump)
        diagnostics
            .warning(cause.span, "jump",
                     "the height of '" + texture.name + "' may jump here, by " + what_of(cause) +
                         ": an impulse in the hand")
            .hint = smooth_form(cause);
    if (found.at_values.smoothness == ir::Smoothness::c0)
        diagnostics
            .note(cause.span, "kink",
                  "the slope of '" + texture.name + "' may step here, by " + what_of(cause) + ": a tick in the hand")
            .hint = smooth_form(cause);
    return found;
}

} // namespace haptel::lang
