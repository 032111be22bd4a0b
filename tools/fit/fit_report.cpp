#include "tools/fit/fit_report.h"

#include "lang/text/number.h"
#include "lang/text/source.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

namespace haptel::tools {

namespace {

const haptel_parameter& described(const haptel_texture& texture, const jit::FittedParameter& found)
{
    return texture.parameters[found.index];
}

// As source text has it.
std::string value_text(const haptel_texture& texture, const jit::FittedParameter& found)
{
    const haptel_parameter& parameter = described(texture, found);
    if (parameter.type == HAPTEL_BOOL) return found.value != 0 ? "true" : "false";
    if (const char* const* names = texture.choices ? texture.choices[found.index] : nullptr)
        return names[static_cast<std::size_t>(found.value)];
    if (parameter.type != HAPTEL_FLOAT) return fmt::format("{:.0f}", found.value);
    const std::string number = fmt::format("{}", found.value);
    const bool is_real = number.find_first_of(".e") != std::string::npos;
    return number + (is_real ? "" : ".0") + std::string(lang::si_unit(parameter.unit));
}

Json value_json(const haptel_texture& texture, const jit::FittedParameter& found)
{
    const uint32_t type = described(texture, found).type;
    if (type == HAPTEL_BOOL) return found.value != 0;
    if (type != HAPTEL_FLOAT && texture.choices && texture.choices[found.index]) return value_text(texture, found);
    return type == HAPTEL_FLOAT ? finite_or_null(found.value) : Json(static_cast<int64_t>(found.value));
}

} // namespace

Json fit_json(const haptel_texture& texture, const jit::FitResult& result)
{
    Json parameters = Json::object(), undetermined = Json::array(), bands = Json::array(), free = Json::array();
    for (const jit::FittedParameter& found : result.parameters) {
        parameters[found.name] = value_json(texture, found);
        if (found.is_free) free.push_back(found.name);
    }
    for (const jit::Undetermined& each : result.undetermined)
        undetermined.push_back({{"name", each.name}, {"why", each.why}});
    for (const jit::FittedBand& band : result.bands)
        bands.push_back({{"from_hz", band.from_hz}, {"to_hz", band.to_hz}, {"off_db", finite_or_null(band.off_db)}});
    const bool is_stroke = !result.bands.empty();
    return {{"parameters", std::move(parameters)},
            {"fitted", std::move(free)},
            {is_stroke ? "error_db" : "error_m", finite_or_null(result.error)},
            {"error", is_stroke ? finite_or_null(result.error) : finite_or_null(result.of_all)},
            {"undetermined", std::move(undetermined)},
            {"bands", is_stroke ? std::move(bands) : Json(nullptr)}};
}

std::string fit_text(const haptel_texture& texture, const jit::FitResult& result)
{
    std::string text;
    for (const jit::FittedParameter& found : result.parameters)
        text +=
            fmt::format("{} = {}{}\n", found.name, value_text(texture, found), found.is_free ? "" : "  (as it was)");
    for (const jit::Undetermined& each : result.undetermined)
        text += fmt::format("undetermined: {}: {}\n", each.name, each.why);
    if (result.bands.empty())
        text += fmt::format("off by {:.3g} m, that is {:.2g} % of the heights (root mean square)\n", result.error,
                            100 * result.of_all);
    else
        text += fmt::format("off by {:.2g} dB over {} thirds of octaves from {:.0f} to {:.0f} Hz (root mean square)\n",
                            result.error, result.bands.size(), result.bands.front().from_hz, result.bands.back().to_hz);
    return text;
}

std::string preset_text(std::string_view name, std::string_view base, const haptel_texture& texture,
                        const jit::FitResult& result, std::string_view measured)
{
    std::vector<std::string> arguments;
    for (std::size_t i = 0; i < result.parameters.size(); ++i) {
        const std::string& first = result.parameters[i].name;
        if (!first.ends_with(".x")) {
            arguments.push_back(fmt::format("{} = {}", first, value_text(texture, result.parameters[i])));
            continue;
        }
        const std::string whole = first.substr(0, first.size() - 2); // its components follow each other
        std::vector<std::string> parts;
        for (; i < result.parameters.size() && result.parameters[i].name.starts_with(whole + "."); ++i)
            parts.push_back(value_text(texture, result.parameters[i]));
        --i;
        arguments.push_back(fmt::format("{} = vec{}({})", whole, parts.size(), fmt::join(parts, ", ")));
    }
    return fmt::format("/// As measured: {}.\ntexture {} = {}({});\n", lang::printable(measured), name, base,
                       fmt::join(arguments, ", "));
}

} // namespace haptel::tools
