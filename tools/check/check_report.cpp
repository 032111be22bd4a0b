#include "tools/check/check_report.h"

#include "lang/abi/outputs.h"
#include "lang/ir/cost.h"
#include "lang/ir/verify.h"
#include "tools/check/check_cost.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <tuple>

namespace haptel::tools {

namespace {

const char* name_of(ir::Type type)
{
    switch (type) {
    case ir::Type::real: return "float";
    case ir::Type::i32: return "int";
    case ir::Type::u32: return "uint";
    case ir::Type::boolean: return "bool";
    case ir::Type::image: return "image";
    }
    return "";
}

Json number_of(const ir::Parameter& parameter, double value)
{
    if (!std::isfinite(value) || parameter.type == ir::Type::image) return nullptr; // no range; no number
    if (parameter.type == ir::Type::boolean) return value != 0;
    if (parameter.type == ir::Type::real) return value;
    return static_cast<int64_t>(value);
}

Json to_json(const ir::Parameter& parameter)
{
    return {{"name", parameter.name},
            {"type", name_of(parameter.type)},
            {"default", number_of(parameter, parameter.value)},
            {"minimum", number_of(parameter, parameter.minimum)},
            {"maximum", number_of(parameter, parameter.maximum)},
            {"choices", parameter.choices},
            {"unit", parameter.unit},
            {"doc", parameter.doc}};
}

Json to_json(const ir::Interval& height_m)
{
    return {{"minimum", finite_or_null(height_m.minimum)}, {"maximum", finite_or_null(height_m.maximum)}};
}

// A curvature is of a gradient without jumps.
bool has_curvature(const ir::TextureBounds& bounds)
{
    return bounds.continuity >= ir::Continuity::c1;
}
Json curvature_of(const ir::TextureBounds& bounds)
{
    return has_curvature(bounds) ? finite_or_null(bounds.curvature_max_per_m) : Json(nullptr);
}

Json continuity_of(const ir::TextureBounds& bounds)
{
    switch (bounds.continuity) {
    case ir::Continuity::unknown: return nullptr;
    case ir::Continuity::jump: return "jump";
    case ir::Continuity::c0: return "C0";
    case ir::Continuity::c1:
    case ir::Continuity::c2:
    case ir::Continuity::smooth: return "C1";
    }
    return nullptr;
}

Json finding_json(const CheckFinding& finding)
{
    return {{"severity", name_of(finding.severity)},
            {"code", finding.code},
            {"message", finding.message},
            {"file", finding.file},
            {"line", finding.begin.line},
            {"column", finding.begin.column},
            {"end_line", finding.end.line},
            {"end_column", finding.end.column},
            {"hint", finding.hint}};
}

uint64_t operations_of(const CheckedTexture& checked)
{
    return ir::operations_max(checked.program->module, checked.texture->height_gradient);
}

// By number of the component.
std::vector<std::string> output_components_of(const ir::Texture& texture)
{
    std::vector<std::string> names;
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t) {
        for (size_t i = 0; i < output.components; ++i) names.push_back(component_name(output, i));
    });
    return names;
}

// "stiffness_scale": {"minimum", "maximum", "over_ranges": {"minimum", "maximum"}}
Json ranges_of(const CheckedTexture& checked)
{
    Json ranges = Json::object();
    const std::vector<std::string> names = output_components_of(*checked.texture);
    for (size_t i = 0; i < names.size(); ++i) {
        ranges[names[i]] = to_json(checked.analysis.outputs[i]);
        ranges[names[i]]["over_ranges"] = to_json(checked.analysis.outputs_over_ranges[i]);
    }
    return ranges;
}

Json checked_json(const CheckedTexture& checked)
{
    Json json = texture_json(checked.file, *checked.texture);
    const auto& heights = checked.heights;
    json.update({{"height_m", to_json(checked.analysis.at_values.height)},
                 {"height_found_m", heights ? to_json(heights->found) : Json(nullptr)},
                 {"height_felt_m", heights ? to_json(heights->felt) : Json(nullptr)},
                 {"slope_max", finite_or_null(checked.analysis.at_values.slope_max)},
                 {"curvature_max_per_m", curvature_of(checked.analysis.at_values)},
                 {"over_ranges",
                  {{"height_m", to_json(checked.analysis.over_ranges.height)},
                   {"slope_max", finite_or_null(checked.analysis.over_ranges.slope_max)},
                   {"curvature_max_per_m", curvature_of(checked.analysis.over_ranges)}}},
                 {"continuity", continuity_of(checked.analysis.at_values)},
                 {"no_jump_found", checked.analysis.no_jump_found},
                 {"output_bounds", ranges_of(checked)},
                 {"declared", checked.analysis.at_values.declared},
                 {"operations_max", operations_of(checked)},
                 {"stability", nullptr}});
    return json;
}

// "-60 um": three digits in the unit that suits the size.
std::string shown_length(double metres)
{
    const double size = std::fabs(metres);
    if (size == 0) return "0";
    if (size < 1e-12) return fmt::format("{:.3g} m", metres); // of rounding
    if (size < 1e-6) return fmt::format("{:.3g} nm", metres * 1e9);
    if (size < 1e-3) return fmt::format("{:.3g} um", metres * 1e6);
    if (size < 1) return fmt::format("{:.3g} mm", metres * 1e3);
    return fmt::format("{:.3g} m", metres);
}

std::string shown_scale(double scale)
{
    return fmt::format("{:.3g}", scale);
}

// "0 .. 1 mm": of heights or scales.
std::string shown_range(const ir::Interval& range, std::string (*shown)(double))
{
    if (range.is_empty()) return "not a number";
    const auto end = [&](double value) { return std::isfinite(value) ? shown(value) : "unbounded"; };
    const bool has_end = std::isfinite(range.minimum) || std::isfinite(range.maximum);
    return has_end ? end(range.minimum) + " .. " + end(range.maximum) : "unbounded";
}

// "at most 3 /m (5 /m)": here, and over the ranges.
std::string shown_bounds(double here, double over_ranges, std::string_view unit)
{
    const auto bound = [&](double value, std::string_view most) {
        return std::isfinite(value) ? fmt::format("{}{:.3g}{}", most, value, unit) : "unbounded";
    };
    return fmt::format("{} ({})", bound(here, "at most "), bound(over_ranges, ""));
}

// The class, and the place that keeps it from being smoother.
std::string shown_class(const CheckedTexture& checked)
{
    const ir::TextureBounds& bounds = checked.analysis.at_values;
    if (bounds.continuity >= ir::Continuity::c1)
        return std::isfinite(bounds.curvature_max_per_m) ? "C1, smooth enough for a bounded change of force"
                                                         : "C1, no kinks, but no bound of how fast the slope changes";
    const std::string_view meaning = bounds.continuity == ir::Continuity::unknown ? "not found"
                                     : checked.analysis.no_jump_found ? "not shown to be continuous, no jump found"
                                     : bounds.continuity == ir::Continuity::jump ? "jump, the height steps"
                                                                                 : "C0, the slope steps";
    const lang::SourceSet& sources = checked.program->sources;
    const lang::Position at = sources.position(bounds.cause.span.file, bounds.cause.span.begin);
    return fmt::format("{}, at {}:{}:{}", meaning, sources.file(bounds.cause.span.file).name, at.line, at.column);
}

// By more than a twentieth of the range.
bool is_lowered_more(const ir::Interval& felt, const ir::Interval& proven)
{
    return felt.maximum - felt.minimum > 1.05 * (proven.maximum - proven.minimum);
}

} // namespace

std::vector<std::string> inputs_of(const ir::Texture& texture)
{
    constexpr const char* names[] = {"p",       "n",         "uv",       "time",         "center",
                                     "extent",  "footprint", "velocity", "normal_force", "tool_radius",
                                     "tangent", "curvature"}; // by bit
    std::vector<std::string> read;
    for (size_t bit = 0; bit < std::size(names); ++bit)
        if (texture.reads >> bit & 1) read.emplace_back(names[bit]);
    return read;
}

std::vector<std::string> outputs_of(const ir::Texture& texture)
{
    std::vector<std::string> written;
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t) { written.emplace_back(output.name); });
    return written;
}

Json texture_json(const std::string& file, const ir::Texture& texture)
{
    Json parameters = Json::array();
    for (const ir::Parameter& parameter : texture.parameters) parameters.push_back(to_json(parameter));
    return {{"file", file},
            {"name", texture.name},
            {"doc", texture.doc},
            {"parameters", std::move(parameters)},
            {"inputs", inputs_of(texture)},
            {"outputs", outputs_of(texture)}};
}

size_t CheckReport::count(lang::Severity severity) const
{
    return static_cast<size_t>(
        std::count_if(findings.begin(), findings.end(), [&](const CheckFinding& f) { return f.severity == severity; }));
}

void CheckReport::add(CheckFinding finding)
{
    const auto key = [](const CheckFinding& f) {
        return std::tie(f.file, f.begin.line, f.begin.column, f.code, f.message);
    };
    const bool known =
        std::any_of(findings.begin(), findings.end(), [&](const CheckFinding& f) { return key(f) == key(finding); });
    if (!known) findings.push_back(std::move(finding));
}

void CheckReport::add(const lang::Diagnostics& diagnostics, const lang::SourceSet& sources)
{
    for (const lang::Diagnostic& said : diagnostics.all())
        add({said.severity, said.code, said.message, said.hint, sources.file(said.span.file).name,
             sources.position(said.span.file, said.span.begin), sources.position(said.span.file, said.span.end)});
}

void CheckReport::add(const lang::CompileResult& result)
{
    add(result.diagnostics, result.sources);
}

Json CheckReport::to_json() const
{
    Json diagnostics = Json::array(), all = Json::array();
    for (const CheckFinding& finding : findings) diagnostics.push_back(finding_json(finding));
    for (const CheckedTexture& checked : textures) {
        all.push_back(checked_json(checked));
        const bool reads_normal = (checked.texture->reads & HAPTEL_READS_NORMAL) != 0;
        all.back()["normal_turn_max_per_m"] = reads_normal ? Json(normal_turn_per_m) : Json(nullptr);
        if (with_cost) {
            all.back()["cost"] = cost_json(checked);
            all.back()["call_s"] = checked.call_s ? Json(*checked.call_s) : Json(nullptr);
        }
        all.back()["precision"] = checked.precision ? precision_json(*checked.precision) : Json(nullptr);
    }
    return {{"diagnostics", std::move(diagnostics)}, {"textures", std::move(all)}};
}

std::string CheckReport::to_text() const
{
    std::string text;
    for (const CheckedTexture& checked : textures) {
        const ir::TextureBounds &here = checked.analysis.at_values, &ranges = checked.analysis.over_ranges;
        const std::vector<std::string> inputs = inputs_of(*checked.texture), outputs = outputs_of(*checked.texture),
                                       components = output_components_of(*checked.texture);
        text += fmt::format("{}:{} in a cube of {} (and over the ranges of its parameters)\n", checked.file,
                            checked.texture->name, shown_length(box_m));
        text += fmt::format("  height     {} ({})\n", shown_range(here.height, shown_length),
                            shown_range(ranges.height, shown_length));
        if (checked.heights && checked.heights->is_bent)
            text += fmt::format("  felt       {}: found were {}, and what lies beyond is bent to stay within\n",
                                shown_range(checked.heights->felt, shown_length),
                                shown_range(checked.heights->found, shown_length));
        else if (checked.heights && is_lowered_more(checked.heights->felt, here.height))
            text += fmt::format("  felt       {}: what a hand waits for is a shorter proof\n",
                                shown_range(checked.heights->felt, shown_length));
        text += fmt::format("  slope      {}\n", shown_bounds(here.slope_max, ranges.slope_max, ""));
        constexpr double infinity = std::numeric_limits<double>::infinity();
        if (has_curvature(here))
            text += fmt::format("  curvature  {}\n",
                                shown_bounds(here.curvature_max_per_m,
                                             has_curvature(ranges) ? ranges.curvature_max_per_m : infinity, " /m"));
        for (size_t i = 0; i < components.size(); ++i)
            text += fmt::format("  {} {} ({})\n", components[i], shown_range(checked.analysis.outputs[i], shown_scale),
                                shown_range(checked.analysis.outputs_over_ranges[i], shown_scale));
        if (!checked.any_picture.empty())
            text += fmt::format("  picture    any, no file is set: --set {}=FILE\n",
                                fmt::join(checked.any_picture, "=FILE --set "));
        text += fmt::format("  class      {}\n", shown_class(checked));
        if (checked.texture->reads & HAPTEL_READS_NORMAL)
            text += fmt::format("  normals    turn at most {:.3g} per metre, or it is steeper (--normal-turn)\n",
                                normal_turn_per_m);
        if (!here.declared.empty())
            text += fmt::format("  declared   believes the facts of {}(); haptel test tries them\n",
                                fmt::join(here.declared, "(), "));
        text += fmt::format("  cost       at most {} operations; reads {}{}\n", operations_of(checked),
                            inputs.empty() ? "nothing" : fmt::format("{}", fmt::join(inputs, ", ")),
                            outputs.empty() ? "" : fmt::format(", writes {}", fmt::join(outputs, ", ")));
        if (checked.call_s)
            text += fmt::format("             {:.3g} ns a call on this machine, measured\n", *checked.call_s * 1e9);
        if (with_cost) text += cost_text(checked);
        if (checked.precision) text += precision_text(*checked.precision);
    }
    return text;
}

} // namespace haptel::tools
