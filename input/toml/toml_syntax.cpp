#include "input/toml/toml_syntax.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace haptel::input {

namespace {

// The parser's words, as far as they tell slips apart, the first that fit. Where a version of it has others nothing but
// the hint is lost.
struct Slip {
    std::string_view words, mend;
};
constexpr Slip slips[] = {
    {"utf-8", "Save the file as UTF-8 text"},
    {"root table: expected keys, tables, whitespace or comments, saw '/'", "A comment begins with `#`"},
    {"root table: expected keys",
     "A scene is a TOML file: `[[object]]` on a line of its own, `shape = \"box\"` on the next"},
    {"table header: expected ']'", "A header is `[servo]`, or `[[object]]` with two brackets at both ends"},
    {"table header: expected a comment", "Keys stand below their header, each on a line of its own"},
    {"as array-of-tables", "Write it in double brackets each time"},
    {"cannot redefine", "It is there twice: leave one of them out"},
    {"expected '=', saw", "Write `key = value`, the key without spaces"},
    {"whitespace, saw ','", "Numbers have a point, such as 0.15; three of them are a list, [0, 0, 0]"},
    {"whitespace, saw ';'", "A line ends without `;`"},
    {"control characters", "Is the closing quote missing?"},
    {"unicode scalar sequence", "In double quotes a backslash is written twice; paths may be written with `/`"},
    {"escape sequence", "In double quotes a backslash is written twice; paths may be written with `/`"},
    {"inline table: expected key or closing '}'",
     "A table in braces stands on one line, with a comma between its keys"},
    {"dangling comma", "Leave the last comma out"},
    {"parsing array", "Three numbers are a list, [0, 0, 0]"},
    {"parsing boolean", "Write `true` or `false`, in small letters; text needs quotes, such as `shape = \"box\"`"},
    {"could not determine value type",
     "Text needs straight quotes, such as `shape = \"box\"`; three numbers are a list, [0, 0, 0]"},
    {"integer: expected digit", "A number with a unit is text, such as `size_m = \"15cm\"`"},
    {"floating-point: expected", "A number with a unit is text, such as `size_m = \"15cm\"`; a point has digits before "
                                 "and behind it, such as 0.5 and 5.0"},
    {"expected value, saw", "Write a value behind the `=`, or leave the key out"},
};

std::string said_of_syntax(const toml::parse_error& problem)
{
    constexpr std::string_view opening = "Error while parsing ", whole_file = "root table";
    const std::string_view found = problem.description();
    std::string said(found);
    if (said.starts_with(opening)) {
        said.replace(0, opening.size(), "cannot read this ");
        if (const std::size_t at = said.find(whole_file); at != std::string::npos)
            said.replace(at, whole_file.size(), "line");
    }
    for (const Slip& slip : slips)
        if (found.find(slip.words) != std::string_view::npos) return said.append(". ").append(slip.mend);
    return said;
}

// Goes through a text by what may hide brackets and dots from a reader: strings and comments.
class Depth {
public:
    explicit Depth(std::string_view text) : text_(text) {}

    // Whether some place is too deep; then that is where it stands.
    bool goes_too_deep()
    {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') {
                skip_string(c);
                continue;
            }
            if (c == '#') {
                at_ = std::min(text_.find('\n', at_), text_.size());
                continue;
            }
            // A key ends where its line, its value or a bracket does.
            if (c == '[' || c == '{') ++open_, dots_ = 0;
            if ((c == ']' || c == '}') && open_ > 0) --open_, dots_ = 0;
            if (c == '\n' || c == '=' || c == ',') dots_ = 0;
            if (c == '.') ++dots_;
            if (open_ + dots_ > levels_max) return true;
            ++at_;
        }
        return false;
    }

    toml::source_position place() const
    {
        const std::string_view before = text_.substr(0, at_);
        const auto lines = std::count(before.begin(), before.end(), '\n');
        const std::size_t line_begin = before.rfind('\n') + 1; // npos + 1: 0
        return {static_cast<toml::source_index>(lines + 1), static_cast<toml::source_index>(at_ - line_begin + 1)};
    }

private:
    // One that does not end on its line is no TOML, unless it is of three quotes.
    void skip_string(char quote)
    {
        const std::string three(3, quote);
        const bool long_one = text_.substr(at_, 3) == three;
        for (at_ += long_one ? 3 : 1; at_ < text_.size(); ++at_) {
            if (text_[at_] == '\\' && quote == '"')
                ++at_;
            else if (long_one ? text_.substr(at_, 3) == three : text_[at_] == quote || text_[at_] == '\n')
                break;
        }
        at_ = std::min(at_ + (long_one ? 3 : 1), text_.size());
        // Up to two quotes before the three that end it are its own.
        for (int own = 0; long_one && own < 2 && at_ < text_.size() && text_[at_] == quote; ++own) ++at_;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    unsigned open_ = 0, dots_ = 0;
};

} // namespace

std::optional<TooDeep> too_deep(std::string_view text)
{
    Depth depth(text);
    if (!depth.goes_too_deep()) return std::nullopt;
    const toml::source_position at = depth.place();
    return TooDeep{{at, at, nullptr},
                   "keys and brackets nest deeper than " + std::to_string(levels_max) +
                       " levels, and a file needs four: is a bracket open, or is it the right file?"};
}

std::optional<toml::table> parse_toml(std::string_view text, FileMessages& messages)
{
    if (const std::optional<TooDeep> fault = too_deep(text)) {
        messages.error(fault->at, fault->message);
        return std::nullopt;
    }
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& problem) {
        messages.error(problem.source(), said_of_syntax(problem));
    }
    return std::nullopt;
}

} // namespace haptel::input
