#include "tests/lang/golden.h"

#include "lang/compile.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace haptel::lang::test {
namespace {

constexpr std::string_view mark = " //! ";

struct Finding {
    std::string text, hint; // text: "line:column severity: message [code]"
};

// Behind "[code]", where " = hint" may follow; messages may hold brackets of their own.
size_t end_of_code(const std::string& one)
{
    for (size_t at = one.find("] = "); at != std::string::npos; at = one.find("] = ", at + 1)) {
        const std::string code = one.substr(one.rfind('[', at) + 1, at - one.rfind('[', at) - 1);
        if (code.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos) return at + 1;
    }
    return one.size();
}

std::vector<Finding> expected_in(const std::string& text)
{
    std::vector<Finding> all;
    std::istringstream lines(text);
    uint32_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        for (size_t at = line.find(mark); at != std::string::npos;) {
            const size_t next = line.find(mark, at + 1);
            std::string one = line.substr(at + mark.size(), next == std::string::npos ? next : next - at - mark.size());
            Finding& finding = all.emplace_back();
            if (const size_t end = end_of_code(one); end != one.size()) {
                finding.hint = one.substr(end + 3);
                one.resize(end);
            }
            finding.text = std::to_string(number) + ":" + one;
            at = next;
        }
    }
    return all;
}

} // namespace

std::string golden_differences(const std::string& text)
{
    std::vector<Finding> expected = expected_in(text);
    const CompileResult result = compile({"golden", text}, {});
    std::string differences;
    for (const Diagnostic& said : result.diagnostics.all()) {
        const Position place = result.sources.position(said.span.file, said.span.begin);
        const std::string found = std::to_string(place.line) + ":" + std::to_string(place.column) + " " +
                                  std::string(name_of(said.severity)) + ": " + said.message + " [" + said.code + "]";
        const auto wanted = std::find_if(expected.begin(), expected.end(), [&](const Finding& finding) {
            return finding.text == found && (finding.hint.empty() || finding.hint == said.hint);
        });
        if (wanted == expected.end())
            differences += "unexpected: " + found + " = " + said.hint + "\n";
        else
            expected.erase(wanted);
    }
    for (const Finding& finding : expected) differences += "missing: " + finding.text + " = " + finding.hint + "\n";
    if ((result.program == nullptr) != result.diagnostics.has_errors()) differences += "a program and errors at once\n";
    return differences;
}

} // namespace haptel::lang::test
