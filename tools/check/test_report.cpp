#include "tools/check/test_report.h"

#include "lang/text/source.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace haptel::tools {

namespace {

Json finite_or_null(const std::optional<double>& value)
{
    return value ? tools::finite_or_null(*value) : Json(nullptr);
}

std::string title(const TestedTexture& texture)
{
    return lang::printable(texture.name.empty() ? texture.file : texture.file + ":" + texture.name);
}

// Of larger errors that are no fault, and what to do about them: lines too.
std::vector<std::string> remarks(const TestedTexture& texture)
{
    if (!texture.amplified) return {};
    const AmplifiedPlace& place = *texture.amplified;
    const jit::AmplifiedRounding& found = *texture.check->amplified;
    std::vector<std::string> lines;
    lines.push_back("rounding is amplified at " + place.where());
    lines.push_back(fmt::format("  by it alone the height is off by {:.1e}, the gradient by {:.1e} of the largest",
                                found.height, found.gradient));
    lines.push_back("  = hint: " + place.hint());
    return lines;
}

Json amplified_json(const TestedTexture& texture)
{
    if (!texture.amplified) return nullptr;
    const AmplifiedPlace& place = *texture.amplified;
    const jit::AmplifiedRounding& found = *texture.check->amplified;
    return {{"file", place.file},
            {"line", place.at.line},
            {"column", place.at.column},
            {"text", place.text},
            {"height_error", tools::finite_or_null(found.height)},
            {"gradient_error", tools::finite_or_null(found.gradient)},
            {"is_hash_of_sine", place.is_hash_of_sine}};
}

std::string figure(const std::optional<double>& value)
{
    return value ? fmt::format("{:.1e}", *value) : "-";
}

// What the columns are, below the table.
constexpr const char* legend = R"(
points    random places in the cube, the same for the same --seed
height    how far the height is off: of all points the most, as a share of the largest height. The truth is the
          texture computed with 113 bits instead of 53, without compiled code
gradient  the same of the gradient, the slope along x, y and z
differ.   the same against slopes measured by small steps: whether the gradient is that of the height
condit.   how much the gradient changes when the place moves by half of its last digit: nothing can be nearer than
          that, so 1e-12 and 8 times this are allowed
kinks     points at an edge, where there is no gradient to compare with; at most 1 % may be
)";

std::string escaped(const std::string& text)
{
    std::string xml;
    for (char c : text) {
        switch (c) {
        case '&': xml += "&amp;"; break;
        case '<': xml += "&lt;"; break;
        case '>': xml += "&gt;"; break;
        case '"': xml += "&quot;"; break;
        default: xml += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
        }
    }
    return xml;
}

} // namespace

std::vector<std::string> reasons(const TestedTexture& texture)
{
    std::vector<std::string> lines;
    if (!texture.fault.empty()) lines.push_back(texture.fault);
    if (!texture.check) return lines;
    lines.insert(lines.end(), texture.check->failures.begin(), texture.check->failures.end());
    return lines;
}

TestedTexture test_texture(const std::shared_ptr<const jit::CompiledProgram>& program, const std::string& file,
                           const std::string& name, const TextureRequest& request, uint32_t points, uint64_t seed)
{
    TestedTexture tested{file, name, {}, {}, 0};
    const auto start = std::chrono::steady_clock::now();
    const TextureResult bound = jit::make_binding(program, name, request, jit::For::figures);
    if (bound.binding)
        tested.check = jit::check_gradient(program, *bound.binding, jit::box_of(request), points, seed);
    else
        tested.fault = bound.diagnostics;
    if (tested.check && tested.check->amplified)
        tested.amplified = place_of(*tested.check->amplified, program->sources());
    tested.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return tested;
}

size_t TestReport::passed() const
{
    const auto passes = [](const auto& tested) { return tested.passed(); };
    return static_cast<size_t>(std::count_if(textures.begin(), textures.end(), passes) +
                               std::count_if(feels.begin(), feels.end(), passes));
}

Json TestReport::to_json() const
{
    Json list = Json::array();
    for (const TestedTexture& texture : textures) {
        Json one;
        one["file"] = texture.file;
        one["name"] = texture.name.empty() ? Json(nullptr) : Json(texture.name);
        const jit::GradientCheck none;
        const jit::GradientCheck& check = texture.check ? *texture.check : none;
        const auto of_check = [&](Json value) { return texture.check ? value : Json(nullptr); };
        one["points"] = of_check(check.points);
        one["height_error_oracle"] = finite_or_null(check.height_error_oracle);
        one["gradient_error_oracle"] = finite_or_null(check.gradient_error_oracle);
        one["conditioning"] = finite_or_null(check.conditioning);
        one["gradient_error_difference"] = finite_or_null(check.gradient_error_difference);
        one["points_at_kinks"] = of_check(check.points_at_kinks);
        one["loop_integral"] = of_check(tools::finite_or_null(check.loop_integral_m));
        one["not_finite"] = of_check(check.not_finite);
        one["bounds_exceeded"] = of_check(check.bounds_exceeded);
        constexpr const char* classes[] = {"", "jump", "C0", "C1"}; // HAPTEL_CONTINUITY_*
        const bool is_measured = check.continuity_measured != HAPTEL_CONTINUITY_UNKNOWN;
        one["continuity_measured"] = is_measured ? Json(classes[check.continuity_measured]) : Json(nullptr);
        one["passed"] = texture.passed();
        one["failures"] = reasons(texture);
        one["amplified_rounding"] = amplified_json(texture);
        list.push_back(std::move(one));
    }
    Json json;
    json["textures"] = std::move(list);
    json["feels"] = Json::array();
    for (const TestedFeel& feel : feels) json["feels"].push_back(tools::to_json(feel));
    json["passed"] = passed();
    json["failed"] = failed();
    return json;
}

std::string TestReport::to_table() const
{
    if (textures.empty()) return table_of(feels) + fmt::format("{} passed, {} failed\n", passed(), failed());
    size_t width = 7;
    for (const TestedTexture& texture : textures) width = std::max(width, title(texture).size());
    std::string text = fmt::format("{:<{}}  {:>7} {:>8} {:>8} {:>8} {:>8} {:>5}  result\n", "texture", width, "points",
                                   "height", "gradient", "differ.", "condit.", "kinks");
    for (const TestedTexture& texture : textures) {
        if (texture.check) {
            const jit::GradientCheck& check = *texture.check;
            const char* result = !texture.passed() ? "FAILED"
                                 : check.amplified ? "passed, amplifies rounding"
                                                   : "passed";
            text += fmt::format("{:<{}}  {:>7} {:>8} {:>8} {:>8} {:>8} {:>5}  {}\n", title(texture), width,
                                check.points, figure(check.height_error_oracle), figure(check.gradient_error_oracle),
                                figure(check.gradient_error_difference), figure(check.conditioning),
                                check.points_at_kinks, result);
        } else {
            text += fmt::format("{:<{}}  {:>7} {:>8} {:>8} {:>8} {:>8} {:>5}  {}\n", title(texture), width, "-", "-",
                                "-", "-", "-", "-", texture.passed() ? "passed, is flat" : "FAILED");
        }
        for (const std::string& line : reasons(texture)) text += "    " + lang::printable(line) + "\n";
        for (const std::string& line : remarks(texture)) text += "    " + lang::printable(line) + "\n";
    }
    return text + table_of(feels) + fmt::format("{} passed, {} failed\n{}", passed(), failed(), legend);
}

std::string TestReport::to_junit() const
{
    std::string xml = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                                  "<testsuite name=\"haptel\" tests=\"{}\" failures=\"{}\">\n",
                                  count(), failed());
    const auto add = [&](const std::string& file, const std::string& name, double seconds, bool has_passed,
                         const std::vector<std::string>& why) {
        xml += fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", escaped(lang::printable(file)),
                           escaped(lang::printable(name)), seconds);
        if (has_passed) {
            xml += "/>\n";
            return;
        }
        std::string lines;
        for (const std::string& reason : why) lines += lang::printable(reason) + "\n";
        xml += ">\n    <failure>" + escaped(lines) + "</failure>\n  </testcase>\n";
    };
    for (const TestedTexture& texture : textures)
        add(texture.file, texture.name, texture.seconds, texture.passed(), reasons(texture));
    for (const TestedFeel& feel : feels) add(feel.file, "feel", feel.seconds, feel.passed(), feel.reasons());
    return xml + "</testsuite>\n";
}

} // namespace haptel::tools
