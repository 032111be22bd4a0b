// Physical dimensions: powers of length and time. Angles and counts are plain numbers. And what the built-in functions
// do with them.
#pragma once

#include "lang/program/builtins.h"

#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace haptel::lang {

// A fraction in lowest terms, denominator > 0.
struct Exponent {
    int32_t numerator = 0, denominator = 1;
    auto operator<=>(const Exponent&) const = default;
};

// The fraction with a denominator of at most 100 that `value` is, but for rounding; nothing if there is none.
std::optional<Exponent> exponent_near(double value);

class Dimension {
public:
    // Fits every dimension: that of a literal 0, of what is not known, and of powers too large to mean anything.
    static constexpr Dimension any() { return {}; }
    static constexpr Dimension of(Exponent length, Exponent time) { return Dimension(length, time); }
    static constexpr Dimension plain() { return of({}, {}); }
    static constexpr Dimension length() { return of({1, 1}, {}); }
    static constexpr Dimension time() { return of({}, {1, 1}); }
    static constexpr Dimension frequency() { return of({}, {-1, 1}); }

    bool is_any() const { return !is_known; }
    bool is_plain() const { return *this == plain(); }
    Exponent length_exponent() const { return length_power; }
    Exponent time_exponent() const { return time_power; }
    // Sorts, for memories by dimension; any comes first.
    auto operator<=>(const Dimension&) const = default;

    Dimension power(Exponent exponent) const;
    friend Dimension operator*(Dimension a, Dimension b);
    friend Dimension operator/(Dimension a, Dimension b) { return a * b.power({-1, 1}); }

private:
    constexpr Dimension() = default;
    constexpr Dimension(Exponent length, Exponent time) : is_known(true), length_power(length), time_power(time) {}
    bool is_known = false;
    Exponent length_power, time_power;
};

// What both can be, nothing if they differ.
std::optional<Dimension> join(Dimension a, Dimension b);

// Of a unit as written ("mm", "deg"); empty: a plain number.
Dimension dimension_of_unit(std::string_view unit);

// "a length", "a plain number", "a quantity in m^2 s^-1".
std::string description(Dimension dimension);
// "a length, a length and a plain number"
std::string description(std::span<const Dimension> dimensions);
// What makes a plain number of it: "divide by a wavelength".
std::string advice_to_plain(Dimension dimension);
// The same without changing the value, behind an expression: " / 1m"; empty where that is not simple.
std::string factor_to_plain(Dimension dimension);
// A unit that gives a bare literal this dimension without changing its value: "m"; empty if there is none.
std::string_view literal_unit(Dimension dimension);

struct DimensionResult {
    Dimension result = Dimension::any();
    // The first argument that does not fit, and what it should be; `fits` if all do.
    bool fits = true;
    size_t argument = 0;
    Dimension expected = Dimension::any();
    bool by_letter = false; // because an argument further left is so
};
// The rule of that function in builtins.def, applied to its arguments.
DimensionResult apply_rule(BuiltinId id, std::span<const Dimension> arguments);

} // namespace haptel::lang
