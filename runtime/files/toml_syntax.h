// What to write where a file is no TOML.
#pragma once

#include <string>

#include <toml++/toml.h>

namespace haptel::runtime {

// What the parser found, and how to mend it where that is a usual slip: text without quotes, a decimal comma, a unit
// without quotes.
std::string said_of_syntax(const toml::parse_error& problem);

} // namespace haptel::runtime
