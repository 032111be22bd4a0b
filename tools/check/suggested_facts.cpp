#include "tools/check/suggested_facts.h"

#include "jit/texture/source_file.h"
#include "lang/syntax/parser.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace haptel::tools {

namespace {

using lang::ast::Function;
using lang::ast::FunctionParameter;

// Times 10^exponent, as a double that is not nearer to 0 than it.
double decimal(double digits, int exponent)
{
    return std::strtod(fmt::format("{:.0f}e{}", digits, exponent).c_str(), nullptr);
}

// The next number up of four digits for what is as large as `scale`.
double rounded_up(double value, double scale)
{
    if (value == 0 || scale == 0 || !std::isfinite(value)) return value;
    const int exponent = static_cast<int>(std::floor(std::log10(scale))) - 3;
    double digits = std::ceil(value / std::pow(10, exponent));
    while (decimal(digits, exponent) < value) ++digits; // the quotient was rounded
    while (decimal(digits - 1, exponent) >= value) --digits;
    return decimal(digits, exponent) + 0.0; // no -0
}

size_t components(const std::string& type)
{
    if (type == "float") return 1;
    return type.size() == 4 && type.starts_with("vec") && type[3] >= '2' && type[3] <= '4'
               ? static_cast<size_t>(type[3] - '0')
               : 0;
}

std::string in_one_line(std::string_view text)
{
    std::string line;
    for (const char c : text)
        if (c != '\n' && c != '\r' && c != '\t' && c != ' ')
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    while (line.ends_with(' ')) line.pop_back();
    return line;
}

// Why its facts cannot be measured; empty: they can.
std::string unfit(const Function& function, const SuggestionOptions& options)
{
    if (components(function.result.base.text) == 0 || function.result.is_array)
        return "facts are of numbers and vectors, and it gives " + function.result.base.text;
    if (function.parameters.empty()) return "it is a constant";
    const FunctionParameter& first = function.parameters.front();
    const size_t size = components(first.type.base.text);
    if (first.is_function || first.type.is_array || size == 0 || size == 4)
        return "its first argument is none of float, vec2 and vec3: measure a function that calls it";
    std::vector<std::string> missing;
    for (const FunctionParameter& parameter : function.parameters) {
        const bool is_given = std::any_of(options.values.begin(), options.values.end(),
                                          [&](const auto& value) { return value.first == parameter.name.text; });
        if (parameter.passing != lang::Passing::in) return "it writes its arguments: measure a function that calls it";
        if (&parameter == &first || parameter.value || is_given) continue;
        missing.push_back(parameter.name.text);
    }
    return missing.empty()
               ? ""
               : fmt::format("further arguments have no value: --set {}=VALUE", fmt::join(missing, "=VALUE --set "));
}

// A texture whose height is a component of the function's value in metres, its argument that many metres of p.
std::string measured_texture(const Function& function, size_t component, const std::string& name,
                             const SuggestionOptions& options)
{
    constexpr const char* arguments[] = {"", "p.x", "p.xy", "p"};
    std::string call =
        function.name.text + "(" + arguments[components(function.parameters.front().type.base.text)] + " / 1m";
    for (size_t i = 1; i < function.parameters.size(); ++i) {
        const FunctionParameter& parameter = function.parameters[i];
        const auto given = std::find_if(options.values.begin(), options.values.end(),
                                        [&](const auto& value) { return value.first == parameter.name.text; });
        if (given == options.values.end()) break; // from here on all have defaults
        call += ", " + given->second;
    }
    call += ")";
    if (components(function.result.base.text) > 1) call += fmt::format(".{}", "xyzw"[component]);
    return fmt::format("\ntexture {}() {{ return 1m * {}; }}\n", name, call);
}

// Whatever is worse.
jit::MeasuredFacts joined(const jit::MeasuredFacts& a, const jit::MeasuredFacts& b)
{
    const auto greater = [](const std::optional<double>& x, const std::optional<double>& y) {
        return x && y ? std::optional(std::max(*x, *y)) : std::nullopt;
    };
    return {std::min(a.value_minimum, b.value_minimum),
            std::max(a.value_maximum, b.value_maximum),
            greater(a.slope, b.slope),
            greater(a.curvature, b.curvature),
            std::min(a.continuity, b.continuity),
            std::max(a.faulty, b.faulty)};
}

class Suggesting {
public:
    Suggesting(std::string of, const SuggestionOptions& chosen) : file(std::move(of)), options(chosen) {}

    std::vector<Suggestion> run(const std::string& wanted)
    {
        jit::SourceText source = jit::read_source(file);
        if (!source.error.empty()) {
            say_error(fmt::format("{}: {}", file, source.error));
            return {};
        }
        if (const auto plain = compiled(source.text); !plain.program) {
            fmt::print(stderr, "{}", plain.rendered(stderr_has_color()));
            return {};
        }
        lang::SourceSet sources;
        const uint32_t index = sources.add({file, source.text});
        lang::Diagnostics heard;
        const lang::ast::File tree = lang::parse(sources, index, heard);
        std::vector<Suggestion> all;
        const Function* last = nullptr; // one that is read for several sizes stands there several times
        for (const Function& function : tree.functions) {
            if (!wanted.empty() && function.name.text != wanted) continue;
            Suggestion one = of_function(function, source.text);
            if (function.body)
                one.head = in_one_line(sources.text({index, function.span.begin, function.body->span.begin}));
            if (last && last->span.begin == function.span.begin && one.skipped.empty() && all.back().skipped.empty())
                all.back().facts = joined(all.back().facts, one.facts);
            else if (!last || last->span.begin != function.span.begin)
                all.push_back(std::move(one));
            last = &function;
        }
        for (const lang::ast::Texture& texture : tree.textures)
            if (wanted.empty() || texture.name.text == wanted) all.push_back(of_texture(texture, source.text));
        return all;
    }

private:
    jit::CompiledTextures compiled(const std::string& text) const
    {
        jit::TextureOptions compile;
        compile.name = file;
        compile.load_import = jit::load_beside;
        compile.entries = jit::Entries::height_gradient;
        compile.precision = jit::Precision::f64;
        return jit::compile_texture(text, compile);
    }

    Suggestion of_function(const Function& function, const std::string& text) const
    {
        Suggestion one{file, function.name.text, function.name.text + "()", unfit(function, options), {}, {}};
        one.where = fmt::format("over {} .. {}", options.least, options.greatest);
        if (!one.skipped.empty()) return one;
        const jit::CheckBox box{{options.least, options.least, options.least},
                                {options.greatest, options.greatest, options.greatest}};
        const size_t count = components(function.result.base.text);
        for (size_t i = 0; i < count && one.skipped.empty(); ++i) {
            const std::string name = "measured_" + function.name.text + "_" + std::to_string(function.span.begin);
            const jit::CompiledTextures measured = compiled(text + measured_texture(function, i, name, options));
            if (!measured.program) {
                fmt::print(stderr, "{}", measured.rendered(stderr_has_color()));
                one.skipped = "a call of it with these arguments does not compile";
                break;
            }
            const auto found = measure(measured, name, box, {}, one);
            one.facts = i == 0 ? found : joined(one.facts, found);
        }
        return one;
    }

    Suggestion of_texture(const lang::ast::Texture& texture, const std::string& text) const
    {
        Suggestion one{file, texture.name.text, "texture " + texture.name.text, {}, {}, {}, true};
        one.where = fmt::format("in a cube of {}m", options.box_m);
        const double half_m = options.box_m / 2;
        const jit::CheckBox box{{-half_m, -half_m, -half_m}, {half_m, half_m, half_m}};
        ParameterTexts values; // each takes those that it has
        for (const auto& value : options.values)
            for (const auto& parameter : texture.parameters)
                if (parameter.name.text == value.first) values.push_back(value);
        one.facts = measure(compiled(text), texture.name.text, box, values, one);
        return one;
    }

    jit::MeasuredFacts measure(const jit::CompiledTextures& from, const std::string& name, const jit::CheckBox& box,
                               const ParameterTexts& values, Suggestion& one) const
    {
        TextureRequest request;
        request.parameters = values;
        request.footprint_m = options.footprint_m;
        std::copy(box.minimum_m, box.minimum_m + 3, request.box_minimum_m);
        std::copy(box.maximum_m, box.maximum_m + 3, request.box_maximum_m);
        const TextureResult bound = jit::make_binding(from.program, name, request, jit::For::figures);
        if (!bound.binding) {
            one.skipped = bound.diagnostics;
            return {};
        }
        const jit::MeasuredFacts facts = jit::measure_facts(*bound.binding, box, options.points, options.seed);
        if (facts.faulty == 1) one.skipped = "it is finite nowhere " + one.where;
        return facts;
    }

    const std::string file;
    const SuggestionOptions& options;
};

} // namespace

std::string facts_line(const jit::MeasuredFacts& facts)
{
    const double scale = std::max(std::abs(facts.value_minimum), std::abs(facts.value_maximum));
    std::string line = fmt::format("@facts value {} .. {}", -rounded_up(-facts.value_minimum, scale) + 0.0,
                                   rounded_up(facts.value_maximum, scale));
    if (facts.slope) line += fmt::format(", slope {}", rounded_up(*facts.slope, *facts.slope));
    if (facts.curvature) line += fmt::format(", curvature {}", rounded_up(*facts.curvature, *facts.curvature));
    constexpr const char* classes[] = {"", "jump", "C0", "C1"}; // HAPTEL_CONTINUITY_*
    return line + ", class " + classes[facts.continuity];
}

std::string Suggestion::text() const
{
    if (!skipped.empty()) return fmt::format("// {}: not measured: {}\n", head, lang::printable(skipped));
    std::string text =
        fmt::format("/// (Facts measured {}, to be confirmed{}.)\n/// {}\n", where,
                    facts.faulty > 0 ? fmt::format("; not finite at {:.2g} % of the places", 100 * facts.faulty) : "",
                    facts_line(facts));
    return text + (is_texture ? "// " + head + ": of its height by p; facts belong to functions, put it into one\n"
                              : head + "\n");
}

Json Suggestion::to_json() const
{
    const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
    Json json{
        {"file", file}, {"name", name}, {"head", head}, {"skipped", skipped.empty() ? Json(nullptr) : Json(skipped)}};
    if (skipped.empty())
        json.update({{"where", where},
                     {"facts", facts_line(facts)},
                     {"value_minimum", facts.value_minimum},
                     {"value_maximum", facts.value_maximum},
                     {"slope", number(facts.slope)},
                     {"curvature", number(facts.curvature)},
                     {"faulty", facts.faulty}});
    return json;
}

std::vector<Suggestion> suggest_facts(const std::string& file, const std::string& name,
                                      const SuggestionOptions& options)
{
    return Suggesting(file, options).run(name);
}

} // namespace haptel::tools
