// Value of a number as written, with its unit: the f64 nearest to the decimal value times the unit's factor, rounded
// once. 0.8mm is the f64 nearest to 0.0008, not 0.8 * 0.001.
#pragma once

#include "lang/text/diagnostic.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace haptel::lang {

constexpr bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

struct Number {
    enum class Kind { real, integer, unsigned_integer } kind = Kind::real;
    double value = 0;          // SI; integers too
    uint64_t integer = 0;      // integer kinds; UINT64_MAX if larger
    std::string_view unit;     // as written; empty: none
    std::string error;         // what is wrong with it, empty: nothing; the rest is then a guess
    ErrorCode code = "number"; // of the error
    std::string hint;
};

// `text`: "0.8mm", "1e-3", "90deg", "0xFFu", "1.0f"; no sign, no spaces. Any bytes: those that are no number give
// `error`.
Number read_number(std::string_view text);

// The SI unit behind a unit as written: "m" for "mm", "rad" for "deg"; empty if there is no such unit.
std::string_view si_unit(std::string_view unit);

} // namespace haptel::lang
