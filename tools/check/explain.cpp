#include "tools/check/explain.h"

#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"
#include "tools/output/json.h"
#include "tools/output/terminal.h"

#include <fmt/format.h>
#include <sstream>

namespace haptel::tools {

namespace {

constexpr size_t columns = 80;

std::string wrapped(std::string_view text)
{
    std::istringstream words{std::string(text)};
    std::string lines, line;
    for (std::string word; words >> word;) {
        if (!line.empty() && line.size() + 1 + word.size() > columns) {
            lines += line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return lines + line + "\n";
}

std::string example(const char* title, std::string_view text)
{
    std::istringstream source{std::string(text)};
    std::string lines = std::string("\n") + title + ":\n";
    for (std::string line; std::getline(source, line);) lines += "    " + lang::printable(line) + "\n";
    return lines;
}

Json to_json(const lang::DiagnosticInfo& info)
{
    return {{"code", info.code},       {"severity", lang::name_of(info.severity)},
            {"meaning", info.meaning}, {"explanation", info.explanation},
            {"wrong", info.wrong},     {"right", info.right}};
}

} // namespace

ExitCode explain(const std::string& code, bool json)
{
    if (code.empty()) {
        Json all = Json::array();
        for (const lang::DiagnosticInfo& info : lang::all_diagnostics) {
            all.push_back(to_json(info));
            if (!json) fmt::print("{:<24} {:<8} {}\n", info.code, lang::name_of(info.severity), info.meaning);
        }
        if (json) print_json({{"codes", std::move(all)}});
        return ExitCode::fine;
    }
    const lang::DiagnosticInfo* info = lang::find_diagnostic(code);
    if (!info) {
        std::vector<std::string_view> codes;
        for (const lang::DiagnosticInfo& known : lang::all_diagnostics) codes.push_back(known.code);
        const std::string_view nearest = near_name(code, codes).name;
        say_error(fmt::format("there is no code '{}': {}", lang::printable(code),
                              nearest.empty() ? "haptel check --explain lists them all"
                                              : fmt::format("did you mean '{}'?", nearest)));
        return ExitCode::misuse;
    }
    if (json) {
        print_json(to_json(*info));
        return ExitCode::fine;
    }
    fmt::print("{} ({}): {}\n\n{}", info->code, lang::name_of(info->severity), info->meaning,
               wrapped(info->explanation));
    if (!info->wrong.empty()) fmt::print("{}{}", example("Wrong", info->wrong), example("Right", info->right));
    return ExitCode::fine;
}

} // namespace haptel::tools
