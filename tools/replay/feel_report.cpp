#include "tools/replay/feel_report.h"

#include "lang/text/source.h"

#include <algorithm>
#include <fmt/format.h>

namespace haptel::tools {

std::vector<std::string> TestedFeel::reasons() const
{
    if (passed()) return {};
    if (!fault.empty()) return {fault};
    std::vector<std::string> lines = lines_of(difference, objects);
    for (std::string& line : lines_of(changed)) lines.push_back(std::move(line));
    lines.push_back("if it is meant to feel so, `haptel test --update-feel " + file + "` makes this the recording");
    return lines;
}

Json to_json(const TestedFeel& feel)
{
    Json json = {{"file", feel.file}};
    json.update(to_json(feel.difference, feel.objects));
    json["changed"] = to_json(feel.changed);
    json["passed"] = feel.passed();
    json["failures"] = feel.reasons();
    return json;
}

std::string table_of(const std::vector<TestedFeel>& feels)
{
    if (feels.empty()) return {};
    std::size_t width = 4;
    for (const TestedFeel& feel : feels) width = std::max(width, lang::printable(feel.file).size());
    std::string text = fmt::format("{:<{}}  {:>7} {:>7} {:>9}  result\n", "feel", width, "ticks", "differ", "most N");
    for (const TestedFeel& feel : feels) {
        const auto& largest = feel.difference.largest;
        text +=
            fmt::format("{:<{}}  {:>7} {:>7} {:>9}  {}\n", lang::printable(feel.file), width, feel.difference.recorded,
                        feel.difference.differing, largest ? fmt::format("{:.1e}", largest->apart()) : "0",
                        feel.passed() ? "passed" : "FAILED");
        for (const std::string& line : feel.reasons()) text += "    " + lang::printable(line) + "\n";
    }
    return text;
}

} // namespace haptel::tools
