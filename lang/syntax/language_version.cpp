#include "lang/syntax/language_version.h"

#include "lang/text/lexer.h"

#include <charconv>
#include <map>
#include <set>

namespace haptel::lang {

VersionFault fault_of_version(std::string_view number, uint32_t present)
{
    const std::string reads = std::to_string(present);
    uint32_t asked = 0;
    const auto [end, fault] = std::from_chars(number.data(), number.data() + number.size(), asked);
    if (fault != std::errc{} || end != number.data() + number.size() || asked == 0)
        return {"expected the version of the language, a whole number from 1 on, found '" + std::string(number) + "'",
                "write language " + reads + ";"};
    const std::string both = "this file is written in version " + std::string(number) +
                             " of the language, and this Haptel reads version " + reads;
    if (asked > present) return {both, "a newer Haptel reads it"};
    if (asked < present) return {both, "'haptel fmt --upgrade' rewrites what has changed"};
    return {};
}

std::vector<FixIt> upgrades(const SourceSet& sources, uint32_t file, Span line, uint32_t from, uint32_t to,
                            std::span<const Renamed> renamed)
{
    Diagnostics ignored; // the parser has told
    const std::vector<PlacedToken> tokens = lex(sources, file, ignored).tokens;
    const auto word = [&](const PlacedToken& token) { return sources.text({file, token.begin, token.end}); };

    std::set<std::string_view> own; // declared here: behind a type
    for (size_t i = 1; i < tokens.size(); ++i)
        if (tokens[i].kind == Token::name &&
            (tokens[i - 1].kind == Token::name || tokens[i - 1].kind == Token::right_bracket))
            own.insert(word(tokens[i]));

    std::map<std::string_view, std::string_view> now; // by what it was called in `from`
    for (const Renamed& row : renamed) {
        if (row.since <= from || row.since > to) continue;
        for (auto& [before, later] : now)
            if (later == row.before) later = row.now;
        now.emplace(row.before, row.now);
    }

    const std::string number = std::to_string(to);
    std::vector<FixIt> fixes;
    const bool has_mark = sources.file(file).text.starts_with("\xef\xbb\xbf");
    const uint32_t begin = has_mark ? 3 : 0;
    if (line.begin == line.end) fixes.push_back({{file, begin, begin}, "language " + number + ";\n\n"});
    for (size_t i = 0; i < tokens.size(); ++i) {
        const PlacedToken& token = tokens[i];
        if (line.begin != line.end && token.begin == line.begin && word(token) != number)
            fixes.push_back({line, number});
        const auto found = token.kind == Token::name ? now.find(word(token)) : now.end();
        const bool is_member = i > 0 && tokens[i - 1].kind == Token::dot;
        if (found != now.end() && !is_member && !own.contains(found->first))
            fixes.push_back({{file, token.begin, token.end}, std::string(found->second)});
    }
    return fixes;
}

} // namespace haptel::lang
