#include "tests/conformance/case.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace haptel::lang::test {
namespace {

std::string shown(double number)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", number);
    return text;
}

bool agrees(double found, double expected, double within)
{
    if (expected == 0) return found == 0 && (!std::signbit(expected) || std::signbit(found));
    return std::fabs(found - expected) <= within * std::fabs(expected);
}

} // namespace

std::string finding_differences(const Case& wanted, const CompileResult& result)
{
    std::vector<ExpectedFinding> expected = wanted.findings;
    std::string differences = wanted.malformed;
    for (const Diagnostic& said : result.diagnostics.all()) {
        const Position from = result.sources.position(said.span.file, said.span.begin);
        const Position to = result.sources.position(said.span.file, said.span.end);
        const std::string file = said.span.file == 0 ? "" : result.sources.file(said.span.file).name + ":";
        const std::string begin = file + std::to_string(from.line) + ":" + std::to_string(from.column);
        const std::string end = to.line == from.line ? "-" + std::to_string(to.column) : "-";
        const std::string text = std::string(name_of(said.severity)) + ": " + said.message + " [" + said.code + "]";
        const auto found = std::find_if(expected.begin(), expected.end(), [&](const ExpectedFinding& finding) {
            return (finding.place == begin || finding.place == begin + end) && finding.text == text &&
                   (finding.hint.empty() || finding.hint == said.hint);
        });
        if (found == expected.end())
            differences += "unexpected: " + begin + end + " " + text + " = " + said.hint + "\n";
        else
            expected.erase(found);
    }
    for (const ExpectedFinding& finding : expected)
        differences += "missing: " + finding.place + " " + finding.text + " = " + finding.hint + "\n";
    if ((result.program == nullptr) != result.diagnostics.has_errors()) differences += "a program and errors at once\n";
    return differences;
}

std::string value_differences(const Evaluation& expected, const std::string& engine, const Outcome& found)
{
    std::string differences;
    const auto compare = [&](const std::string& name, double is, double should) {
        if (!agrees(is, should, expected.within))
            differences += engine + ": expected " + name + " " + shown(should) + ", found " + shown(is) + ": " +
                           expected.line + "\n";
    };
    if (expected.height) compare("height", found.height, *expected.height);
    for (const auto& [name, components] : expected.outputs)
        for (size_t i = 0; i < components.size(); ++i)
            compare(name, components_of(found.sample, *find_output(name))[i], components[i]);
    for (size_t i = 0; expected.gradient && i < 3; ++i) compare("gradient", found.gradient[i], (*expected.gradient)[i]);
    compare("faults", found.faults, expected.faults);
    return differences;
}

std::string golden_differences(const std::string& text)
{
    const Case wanted = read_case(text);
    CompileOptions options;
    options.load_import = wanted.loader();
    options.strict = wanted.strict;
    return finding_differences(wanted, compile(wanted.main, options));
}

} // namespace haptel::lang::test
