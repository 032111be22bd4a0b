#include "lang/text/directive.h"

namespace haptel::lang {
namespace {

std::string_view trimmed(std::string_view text)
{
    const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t\r");
    return first == text.npos ? std::string_view{} : text.substr(first, last - first + 1);
}

} // namespace

std::optional<bool> Conditions::chosen(std::string_view word, std::string_view line) const
{
    std::string_view asked = trimmed(line);
    if (word == "#ifdef") return defined.contains(asked);
    if (word == "#ifndef") return !defined.contains(asked);
    const bool is_negated = asked.starts_with('!');
    if (is_negated) asked = trimmed(asked.substr(1));
    if (asked == "0" || asked == "1") return (asked == "1") != is_negated;
    if (!asked.starts_with("defined")) return std::nullopt;
    asked = trimmed(asked.substr(7));
    if (asked.starts_with('(') && asked.ends_with(')')) asked = trimmed(asked.substr(1, asked.size() - 2));
    if (asked.find_first_of(" \t()&|!") != asked.npos) return std::nullopt;
    return defined.contains(asked) != is_negated;
}

} // namespace haptel::lang
