// The text of a TOML file as a table, or what is wrong with it and how to mend it.
#pragma once

#include "input/toml/file_messages.h"

#include <optional>
#include <string>
#include <string_view>

namespace haptel::input {

// Nothing, and an error, where it is no TOML: what the parser found, and how to mend it where that is a usual slip:
// text without quotes, a decimal comma, a unit without quotes. Harmless whatever the bytes.
std::optional<toml::table> parse_toml(std::string_view text, FileMessages& messages);

struct TooDeep {
    toml::source_region at;
    std::string message;
};

// The first place where keys and brackets nest deeper than any scene does. The parser, and what it makes, call
// themselves for each level: some ten thousand of them end the stack. To be asked before it reads. Of what is no TOML
// it may take any view.
std::optional<TooDeep> too_deep(std::string_view text);
inline constexpr unsigned levels_max = 64;

} // namespace haptel::input
