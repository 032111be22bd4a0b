#include "lang/analyse.h"

#include "lang/abi/outputs.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

namespace haptel::lang {
namespace {

using ir::infinity;
using ir::Input;
using ir::Op;

ir::BoundsBox box_of(const AnalysedCube& where)
{
    const double side_m = where.side_m, footprint_m = where.footprint_m, turn_per_m = where.normal_turn_max_per_m;
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
    ir::set_contact(box);
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
    return std::string(ir::traits(*cause.op).instead);
}

std::string shown(double value)
{
    if (!std::isfinite(value)) return "unbounded";
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

std::string shown(const ir::Interval& range)
{
    return shown(range.minimum) + " .. " + shown(range.maximum);
}

// As the author wrote it.
std::string name_of(Op op)
{
    const std::string name(ir::called(op));
    return name.find(' ') == name.npos ? name + "()" : name;
}

// The call that all of `text` is, as it was written: "clamp()" of "clamp(x, 0.0, 1.0)", "grad(noise)" of
// "grad(noise)(q)"; empty where it is none.
std::string call_in(std::string_view text)
{
    const size_t open = text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_");
    if (open == 0 || open == text.npos || text[open] != '(') return {};
    size_t close = open;
    for (int nesting = 0; close < text.size(); ++close) {
        nesting += (text[close] == '(') - (text[close] == ')');
        if (nesting == 0) break;
    }
    if (close + 1 == text.size()) return std::string(text.substr(0, open)) + "()";
    return close + 1 < text.size() && text[close + 1] == '(' ? std::string(text.substr(0, close + 1)) : std::string();
}

std::string what_of(const ir::Cause& cause, const SourceSet& sources)
{
    const std::string call = call_in(sources.text(cause.span));
    if (!call.empty()) return printable(call);
    return cause.op ? name_of(*cause.op) : cause.is_library ? "this call" : "this choice";
}

void report(const ir::Undefined& found, Diagnostics& diagnostics)
{
    using Why = ir::Undefined::Why;
    const auto warn = [&](WarningCode code, const std::string& message, const char* hint) {
        diagnostics.warning(found.span, code, message, hint);
    };
    if (found.why == Why::not_looked_at)
        return warn("domain", "whether this is finite was not found out",
                    "it takes too many operations to look at: fewer trips of its loops would tell");
    if (!found.op)
        return warn("domain", "a constant here is not a finite number",
                    "a division by 0, or a function outside of where it is defined, was computed once and for all");
    const std::string name = name_of(*found.op), operand = shown(found.operand);
    const std::string where = ": its argument lies in " + operand;
    switch (found.why) {
    case Why::not_looked_at: return;
    case Why::pole:
        if (*found.op == Op::div)
            return warn(
                "division", "this may divide by zero: the divisor lies in " + operand,
                "add a small constant, or keep it away from 0 with max(); where it is 0 the height counts as 0");
        return warn("domain", name + " may be infinite" + where,
                    "keep it away from there, with max() or clamp(); else the height counts as 0");
    case Why::domain:
        return warn("domain", name + " may be not a number" + where,
                    "keep it where the function is defined, with clamp(), max() or abs(); else the height counts as 0");
    case Why::overflow:
        return warn("domain", name + " may be larger than any number" + where,
                    "keep it small, with clamp() or min(); else the height counts as 0");
    case Why::derivative:
        return warn("domain", "the derivative of " + name + " may be not finite" + where,
                    "keep it away from there, with clamp() or max(); else the gradient counts as 0");
    }
}

void report(const ir::FalseFact& fact, Diagnostics& diagnostics)
{
    using What = ir::FalseFact::What;
    const auto most = [](const std::optional<double>& size) { return shown(size.value_or(infinity)); };
    const std::string said =
        fact.what == What::value ? "a value within " + shown({*fact.facts.value_minimum, *fact.facts.value_maximum}) +
                                       ", found " + shown(fact.found)
        : fact.what == What::slope ? "a slope of at most " + most(fact.facts.slope) + ", found a steeper place"
                                   : "a curvature of at most " + most(fact.facts.curvature) + ", found a greater one";
    diagnostics.warning(
        fact.facts.span, "false-facts", "this function is not as its facts say: expected " + said,
        "bounds are computed with what is declared here, and are wrong if it is: haptel test measures the true sizes");
}

std::string place_of(const double (&p_m)[3])
{
    std::array<char, 96> text;
    std::snprintf(text.data(), text.size(), "(%.4g, %.4g, %.4g) mm", 1e3 * p_m[0], 1e3 * p_m[1], 1e3 * p_m[2]);
    return text.data();
}

std::string when_of(const ir::Texture& texture, double time_s)
{
    if (!(texture.reads & HAPTEL_READS_TIME)) return {};
    std::array<char, 48> text;
    std::snprintf(text.data(), text.size(), " at %.4g s", time_s);
    return text.data();
}

// Whether it does, or may for all that is known.
bool report_jump(const ir::Texture& texture, const ir::Cause& cause, const std::string& by, const JumpSearch& seek_jump,
                 Diagnostics& diagnostics)
{
    const std::string height = "the height of '" + texture.name + "' ";
    const std::optional<SeenJump> seen = seek_jump ? seek_jump() : std::nullopt;
    if (seek_jump && !seen) {
        diagnostics.note(cause.span, "seam",
                         height + "is not shown to be continuous here, " + by + "; a search found no jump",
                         "if you know that both sides meet, put it into a function with a line /// @facts class C0");
        return false;
    }
    std::array<char, 32> size;
    if (seen) std::snprintf(size.data(), size.size(), "%.3g um", 1e6 * seen->height_m);
    diagnostics.warning(cause.span, "jump",
                        seen ? height + "jumps by " + size.data() + " at " + place_of(seen->p_m) +
                                   when_of(texture, seen->time_s) + ", " + by + " or the like: an impulse in the hand"
                             : height + "may jump here, " + by + ": an impulse in the hand",
                        smooth_form(cause));
    return true;
}

// A scale that is no number, or would pull instead of push, counts as 1: no author means that.
void report_scales(const ir::Texture& texture, std::span<const ir::Interval> scales, Diagnostics& diagnostics)
{
    size_t next = 0;
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
        const Span span = texture.output_spans[next++];
        for (size_t i = 0; i < output.components; ++i) {
            const ir::Interval& scale = scales[first + i];
            const bool is_negative = scale.is_finite(); // else that is worse
            if (is_negative && (scale.minimum >= 0 || !output.is_never_negative)) continue;
            const std::string what = scale.is_empty() ? "is not a number" : "lies in " + shown(scale);
            const std::string counts = std::string(" it counts as ") + (output.value == 0 ? "0" : "1");
            diagnostics.warning(
                span, "scale",
                component_name(output, i) + " of '" + texture.name + "' may be " +
                    (is_negative ? "negative" : "not finite") + ": it " + what,
                is_negative
                    ? "keep it at 0 or above, with max(x, 0.0) or clamp(); where it is negative" + counts
                    : "keep it bounded, with clamp(), or its divisors away from 0; where it is not finite" + counts);
            return;
        }
    });
}

} // namespace

Analysis analyse(const Program& program, const ir::Texture& texture, std::span<const double> values,
                 std::span<const ir::SplineImage* const> images, const AnalysedCube& where, Diagnostics& diagnostics,
                 const JumpSearch& seek_jump)
{
    ir::BoundsBox at_values = box_of(where);
    at_values.images.assign(images.begin(), images.end());
    ir::BoundsBox over_ranges = at_values;
    for (size_t i = 0; i < values.size(); ++i) {
        at_values.parameters.push_back({values[i], values[i]});
        over_ranges.parameters.push_back(range_of(texture.parameters[i], values[i]));
    }
    Analysis found{ir::texture_bounds(program.module, texture, at_values, where.evaluations),
                   {},
                   ir::output_bounds(program.module, texture, at_values, where.evaluations),
                   {}};
    const bool has_ranges = !std::ranges::all_of(over_ranges.parameters, &ir::Interval::is_point);
    found.over_ranges =
        has_ranges ? ir::texture_bounds(program.module, texture, over_ranges, where.evaluations) : found.at_values;
    found.outputs_over_ranges =
        has_ranges ? ir::output_bounds(program.module, texture, over_ranges, where.evaluations) : found.outputs;
    report_scales(texture, found.outputs_over_ranges, diagnostics);
    std::set<std::pair<uint32_t, ir::FalseFact::What>> told; // by place: each once
    for (const ir::TextureBounds* bounds : {&found.at_values, &found.over_ranges})
        for (const ir::FalseFact& fact : bounds->contradicted)
            if (told.emplace(fact.facts.span.begin, fact.what).second) report(fact, diagnostics);

    const std::vector<ir::Undefined> said = ir::undefined_in(program.module, texture, over_ranges);
    for (const ir::Undefined& undefined : said) report(undefined, diagnostics);
    const ir::Cause& cause = found.at_values.cause;
    const auto is_same_place = [&](const ir::Undefined& undefined) { // what is no number somewhere may jump elsewhere
        if (undefined.why == ir::Undefined::Why::domain && found.at_values.continuity == ir::Continuity::jump)
            return false;
        return undefined.span.file == cause.span.file && undefined.span.begin == cause.span.begin;
    };
    if (std::any_of(said.begin(), said.end(), is_same_place)) return found;
    const auto by = [&] { return "by " + what_of(cause, program.sources); };
    if (found.at_values.continuity == ir::Continuity::jump)
        found.no_jump_found = !report_jump(texture, cause, by(), seek_jump, diagnostics);
    if (found.at_values.continuity == ir::Continuity::c0)
        diagnostics.note(cause.span, "kink",
                         "the slope of '" + texture.name + "' may step here, " + by() + ": a tick in the hand",
                         smooth_form(cause));
    return found;
}

} // namespace haptel::lang
