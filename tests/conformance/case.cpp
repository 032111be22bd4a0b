#include "tests/conformance/case.h"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace haptel::lang::test {
namespace {

constexpr std::string_view finding_mark = "//! ", value_mark = "//= ", option_mark = "//@ ", file_mark = "//--- ";

// Behind "[code]", where " = hint" may follow; messages may hold brackets of their own.
size_t end_of_code(const std::string& one)
{
    for (size_t at = one.find("] = "); at != std::string::npos; at = one.find("] = ", at + 1)) {
        const std::string code = one.substr(one.rfind('[', at) + 1, at - one.rfind('[', at) - 1);
        if (code.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos) return at + 1;
    }
    return one.size();
}

// "11-20 error: message [code] = hint"
ExpectedFinding finding_in(std::string one, const std::string& line_name)
{
    ExpectedFinding finding;
    if (const size_t end = end_of_code(one); end != one.size()) {
        finding.hint = one.substr(end + 3);
        one.resize(end);
    }
    const size_t space = one.find(' ');
    finding.place = line_name + ":" + one.substr(0, space);
    finding.text = space == std::string::npos ? "" : one.substr(space + 1);
    return finding;
}

bool read_number(std::string_view text, double& number)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

// As many numbers between commas as there are places.
bool read_numbers(std::string_view text, double* places, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        const size_t comma = i + 1 < count ? text.find(',') : text.size();
        if (comma == std::string_view::npos || !read_number(text.substr(0, comma), places[i])) return false;
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return true;
}

bool read_word(Evaluation& into, const std::string& name, const std::string& value)
{
    double number = 0;
    if (name.starts_with("set.")) {
        into.parameters.emplace_back(name.substr(4), value);
        const bool is_choice = value.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == value.npos;
        return is_choice ? !value.empty() : read_number(value, number);
    }
    const std::pair<std::string_view, std::pair<double*, size_t>> given[] = {
        {"p", {into.point.p, 3}},
        {"n", {into.point.n, 3}},
        {"uv", {into.point.uv, 2}},
        {"time", {&into.point.time_s, 1}},
        {"n_dp", {&into.point.n_dp[0][0], 9}},
        {"uv_dp", {&into.point.uv_dp[0][0], 6}},
        {"velocity", {into.point.velocity, 3}},
        {"normal_force", {&into.point.normal_force_n, 1}},
        {"tool_radius", {&into.point.tool_radius_m, 1}},
        {"tangent", {into.point.tangent, 3}},
        {"bitangent", {into.point.bitangent, 3}},
        {"curvature", {&into.point.curvature_per_m, 1}},
        {"center", {into.head.center, 3}},
        {"extent", {into.head.extent, 3}},
        {"footprint", {&into.head.footprint_m, 1}},
        {"within", {&into.within, 1}},
        {"oracle", {&into.with_oracle, 1}},
    };
    for (const auto& [word, place] : given)
        if (name == word) return read_numbers(value, place.first, place.second);
    if (name == "gradient") return read_numbers(value, into.gradient.emplace().data(), 3);
    if (const OutputInfo* output = find_output(name.starts_with("out.") ? name.substr(4)
                                               : name == "stiffness"    ? "stiffness_scale"
                                               : name == "friction"     ? "friction_scale"
                                                                        : "")) {
        std::vector<double> components(output->components);
        const bool is_read = read_numbers(value, components.data(), components.size());
        into.outputs.emplace_back(output->name, std::move(components));
        return is_read;
    }
    if (!read_number(value, number)) return false;
    if (name == "faults") {
        into.faults = static_cast<uint32_t>(number);
        return true;
    }
    if (name != "height") return false;
    into.height = number;
    return true;
}

Evaluation evaluation_in(const std::string& text, std::string& malformed)
{
    Evaluation evaluation;
    evaluation.line = text;
    evaluation.point.n[2] = 1;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const size_t equals = word.find('=');
        if (equals == std::string::npos || !read_word(evaluation, word.substr(0, equals), word.substr(equals + 1)))
            malformed += "malformed: '" + word + "' in " + text + "\n";
    }
    return evaluation;
}

} // namespace

Case read_case(const std::string& text)
{
    Case made;
    made.main.name = "main.haptel";
    std::string file;              // being read; empty: the main one
    uint32_t number = 0, last = 0; // of lines; `last` that holds source
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(file_mark)) {
            file = line.substr(file_mark.size());
            number = last = 0;
            continue;
        }
        if (file == "findings") {
            const size_t space = line.find(' ');
            const std::string place = line.substr(0, space),
                              rest = space == std::string::npos ? "" : line.substr(space);
            made.findings.push_back(
                finding_in(place.substr(place.find(':') + 1) + rest, place.substr(0, place.find(':'))));
            continue;
        }
        (file.empty() ? made.main.text : made.imports[file]) += line + "\n";
        ++number;
        const size_t first = std::min(line.find_first_not_of(' '), line.size());
        const std::string_view rest = std::string_view(line).substr(first);
        if (rest.starts_with(value_mark)) {
            made.evaluations.push_back(evaluation_in(std::string(rest.substr(value_mark.size())), made.malformed));
            continue;
        }
        if (rest.starts_with(option_mark)) {
            const std::string_view option = rest.substr(option_mark.size());
            if (option == "bounds")
                made.with_bounds = true;
            else if (option == "strict")
                made.strict = true;
            else
                made.malformed += "malformed: " + line + "\n";
            continue;
        }
        if (!rest.starts_with(finding_mark)) last = number;
        const std::string name = (file.empty() ? "" : file + ":") + std::to_string(last);
        for (size_t at = line.find(finding_mark); at != std::string::npos;) {
            const size_t next = line.find(finding_mark, at + 1), begin = at + finding_mark.size();
            std::string one = line.substr(begin, next == std::string::npos ? next : next - begin);
            if (next != std::string::npos) one.resize(one.find_last_not_of(' ') + 1);
            made.findings.push_back(finding_in(one, name));
            at = next;
        }
    }
    return made;
}

ImportLoader Case::loader() const
{
    return [files = imports](std::string_view path, std::string_view) -> std::optional<SourceFile> {
        const auto found = files.find(std::string(path));
        if (found == files.end()) return std::nullopt;
        return SourceFile{found->first, found->second};
    };
}

} // namespace haptel::lang::test
