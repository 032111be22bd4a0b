// What to write where a file is no TOML, and what keeps the parser of TOML from harm.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace haptel::runtime {

// What the parser found, and how to mend it where that is a usual slip: text without quotes, a decimal comma, a unit
// without quotes.
std::string said_of_syntax(const toml::parse_error& problem);

struct TooDeep {
    toml::source_region at;
    std::string message;
};

// The first place where keys and brackets nest deeper than any scene does. The parser, and what it makes, call
// themselves for each level: some ten thousand of them end the stack. To be asked before it reads. Of what is no TOML
// it may take any view.
std::optional<TooDeep> too_deep(std::string_view text);
inline constexpr unsigned levels_max = 64;

} // namespace haptel::runtime
