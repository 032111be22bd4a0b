#include "tools/check/check_precision.h"

#include "jit/texture/texture.h"
#include "tools/arguments/precisions.h"

#include <algorithm>
#include <fmt/format.h>

namespace haptel::tools {
namespace {

using jit::PrecisionFigures;

const char* name_of(const PrecisionFigures* figures)
{
    for (const NamedPrecision& known : precisions)
        if (figures && known.precision == figures->precision) return known.name;
    return "none";
}

Json name_or_null(const PrecisionFigures* figures)
{
    return figures ? Json(name_of(figures)) : Json(nullptr);
}

const PrecisionFigures* for_one(const CheckedPrecision& checked)
{
    return fastest(checked.choice, &PrecisionFigures::one_point_ns, checked.error_max);
}

const PrecisionFigures* for_many(const CheckedPrecision& checked)
{
    return fastest(checked.choice, &PrecisionFigures::many_points_ns, checked.error_max);
}

} // namespace

bool CheckedPrecision::is_met() const
{
    return for_one(*this) != nullptr;
}

bool CheckedPrecision::takes_f64() const
{
    const PrecisionFigures* picked = for_many(*this);
    return !picked || picked->precision == jit::Precision::f64;
}

std::string CheckedPrecision::closest() const
{
    const auto best = std::min_element(
        choice.figures.begin(), choice.figures.end(),
        [](const PrecisionFigures& a, const PrecisionFigures& b) { return a.gradient_error < b.gradient_error; });
    return fmt::format("{} is off by {:.2g}", name_of(&*best), best->gradient_error);
}

std::optional<AmplifiedPlace> find_amplified(const std::string& file, const std::string& texture,
                                             const TextureRequest& request)
{
    jit::TextureOptions compile;
    compile.only_texture = texture;
    compile.entries = jit::Entries::height_gradient;
    const auto program = jit::compile_texture_file(file, compile).program;
    if (!program) return std::nullopt;
    const TextureResult bound = jit::make_binding(program, texture, request, jit::For::figures);
    if (!bound.binding) return std::nullopt;
    const auto found = jit::check_gradient(program, *bound.binding, jit::box_of(request)).amplified;
    return found ? std::optional(place_of(*found, program->sources())) : std::nullopt;
}

Json precision_json(const CheckedPrecision& checked)
{
    Json measured = Json::array();
    for (const PrecisionFigures& figures : checked.choice.figures)
        measured.push_back({{"precision", name_of(&figures)},
                            {"height_error", finite_or_null(figures.height_error)},
                            {"gradient_error", finite_or_null(figures.gradient_error)},
                            {"one_point_ns", figures.one_point_ns},
                            {"many_points_ns", figures.many_points_ns}});
    return {{"error_max", checked.error_max},
            {"one_point", name_or_null(for_one(checked))},
            {"many_points", name_or_null(for_many(checked))},
            {"amplified_rounding", checked.amplified ? Json(checked.amplified->where()) : Json(nullptr)},
            {"measured", std::move(measured)}};
}

std::string precision_text(const CheckedPrecision& checked)
{
    std::string text =
        fmt::format("  precision  {} for one point, {} for many: the fastest whose gradient is off by at most {:g}\n",
                    name_of(for_one(checked)), name_of(for_many(checked)), checked.error_max);
    for (const PrecisionFigures& figures : checked.choice.figures)
        text +=
            fmt::format("    {:<6} gradient off by {:.1e}, height by {:.1e}; {:.1f} ns for one point, {:.1f} ns for "
                        "each of many\n",
                        name_of(&figures), figures.gradient_error, figures.height_error, figures.one_point_ns,
                        figures.many_points_ns);
    if (checked.amplified)
        text += fmt::format("    rounding is amplified at {}\n    = hint: {}\n",
                            lang::printable(checked.amplified->where()), checked.amplified->hint());
    return text;
}

} // namespace haptel::tools
