// The one way to JSON on standard output: valid UTF-8 whatever the source holds, never NaN or Infinity (null), numbers
// in shortest round-trip form, fields in the order in which they were added.
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace haptel::tools {

using Json = nlohmann::ordered_json;

// A number, or null where it is not finite: "unbounded or not found" of the language's facts.
Json finite_or_null(double value);

// A value, or null where there is none.
template <typename T>
Json value_or_null(const std::optional<T>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

// Each line of a text.
Json lines_of(const std::string& text);

// Indented text without a final newline; bytes that are no UTF-8 become U+FFFD.
std::string to_text(const Json& json);

// Prints to_text and a newline on standard output.
void print_json(const Json& json);

} // namespace haptel::tools
