#include "lang/check/dimension/dimension.h"

#include "lang/text/number.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace haptel::lang {
namespace {

constexpr int64_t part_max = 10'000; // of an exponent: keeps products of two inside 64 bits by far

std::optional<Exponent> reduced(int64_t numerator, int64_t denominator)
{
    const int64_t common = std::gcd(numerator, denominator);
    numerator /= common;
    denominator /= common;
    if (std::abs(numerator) > part_max || denominator > part_max) return std::nullopt;
    return Exponent{static_cast<int32_t>(numerator), static_cast<int32_t>(denominator)};
}

std::optional<Exponent> sum(Exponent a, Exponent b)
{
    return reduced(int64_t{a.numerator} * b.denominator + int64_t{b.numerator} * a.denominator,
                   int64_t{a.denominator} * b.denominator);
}

std::optional<Exponent> product(Exponent a, Exponent b)
{
    return reduced(int64_t{a.numerator} * b.numerator, int64_t{a.denominator} * b.denominator);
}

// " m^2"; empty for power 0.
std::string unit_power(const char* unit, Exponent power)
{
    if (power.numerator == 0) return {};
    std::string text = std::string(" ") + unit;
    if (power == Exponent{1, 1}) return text;
    text += "^" + std::to_string(power.numerator);
    if (power.denominator != 1) text += "/" + std::to_string(power.denominator);
    return text;
}

struct Known {
    Dimension dimension;
    const char* description;
    const char* advice;         // how to make a plain number of it
    std::string_view unit = {}; // SI
};

constexpr Known all_known[] = {
    {Dimension::plain(), "a plain number", ""},
    {Dimension::length(), "a length", "divide by a wavelength", "m"},
    {Dimension::time(), "a time", "divide by a period", "s"},
    {Dimension::frequency(), "a frequency", "multiply by a time", "Hz"},
    {Dimension::of({2, 1}, {}), "an area", "divide by an area"},
    {Dimension::of({3, 1}, {}), "a volume", "divide by a volume"},
    {Dimension::of({-1, 1}, {}), "a number per length", "multiply by a length", "1/m"},
    {Dimension::of({1, 1}, {-1, 1}), "a speed", "divide by a speed", "m/s"},
    {Dimension::of({1, 1}, {-2, 1}), "an acceleration", "divide by an acceleration"},
};

const Known* known(Dimension dimension)
{
    const auto found = std::ranges::find(all_known, dimension, &Known::dimension);
    return found == std::end(all_known) ? nullptr : found;
}

std::string units_of(Dimension dimension)
{
    return (unit_power("m", dimension.length_exponent()) + unit_power("s", dimension.time_exponent())).substr(1);
}

// The dimensions that the letters a, b, c stand for, as far as arguments have said.
using Letters = std::array<Dimension, 3>;

// "1", "a", "ab", "a^-1/2", "am^-1"
Dimension evaluate(std::string_view term, const Letters& letters)
{
    Dimension product = Dimension::plain();
    while (!term.empty()) {
        const char letter = term.front();
        term.remove_prefix(1);
        if (letter == '1') continue;
        Exponent exponent{1, 1};
        if (term.starts_with('^')) {
            const char* const end = term.data() + term.size();
            const char* at = std::from_chars(term.data() + 1, end, exponent.numerator).ptr;
            if (at != end && *at == '/') at = std::from_chars(at + 1, end, exponent.denominator).ptr;
            term = {at, end};
        }
        const Dimension base = letter == 'm' ? Dimension::length() : letters[static_cast<size_t>(letter - 'a')];
        product = product * base.power(exponent);
    }
    return product;
}

} // namespace

std::optional<Exponent> exponent_near(double value)
{
    constexpr int64_t denominator_max = 100;
    constexpr double rounding = 1e-12; // relative
    for (int64_t denominator = 1; denominator <= denominator_max; ++denominator) {
        const double numerator = std::round(value * static_cast<double>(denominator));
        if (!(std::fabs(numerator) <= static_cast<double>(part_max))) return std::nullopt;
        if (std::fabs(numerator / static_cast<double>(denominator) - value) <= rounding * std::fabs(value))
            return reduced(static_cast<int64_t>(numerator), denominator);
    }
    return std::nullopt;
}

Dimension Dimension::power(Exponent exponent) const
{
    const auto length = product(length_power, exponent), time = product(time_power, exponent);
    return is_known && length && time ? of(*length, *time) : any();
}

Dimension operator*(Dimension a, Dimension b)
{
    const auto length = sum(a.length_power, b.length_power), time = sum(a.time_power, b.time_power);
    return a.is_known && b.is_known && length && time ? Dimension::of(*length, *time) : Dimension::any();
}

std::optional<Dimension> join(Dimension a, Dimension b)
{
    if (a.is_any()) return b;
    if (b.is_any() || a == b) return a;
    return std::nullopt;
}

Dimension dimension_of_unit(std::string_view unit)
{
    const std::string_view written = si_unit(unit), si = written.empty() ? unit : written;
    const auto found = std::ranges::find(all_known, si, &Known::unit);
    return unit.empty() || found == std::end(all_known) ? Dimension::plain() : found->dimension;
}

std::string description(Dimension dimension)
{
    if (dimension.is_any()) return "any number";
    if (const Known* entry = known(dimension)) return entry->description;
    return "a quantity in " + units_of(dimension);
}

std::string description(std::span<const Dimension> dimensions)
{
    std::string text;
    for (size_t i = 0; i < dimensions.size(); ++i)
        text += (i == 0 ? "" : i + 1 < dimensions.size() ? ", " : " and ") + description(dimensions[i]);
    return text;
}

std::string advice_to_plain(Dimension dimension)
{
    if (const Known* entry = known(dimension)) return entry->advice;
    return dimension.is_any() ? std::string{} : "divide by a quantity in " + units_of(dimension);
}

std::string factor_to_plain(Dimension dimension)
{
    constexpr int32_t factors_max = 3;
    if (dimension.is_any()) return {};
    std::string text;
    for (const auto& [power, unit] :
         {std::pair{dimension.length_exponent(), "1m"}, std::pair{dimension.time_exponent(), "1s"}}) {
        if (power.denominator != 1 || std::abs(power.numerator) > factors_max) return {};
        for (int32_t i = 0; i < std::abs(power.numerator); ++i)
            text += std::string(power.numerator > 0 ? " / " : " * ") + unit;
    }
    return text;
}

std::string_view literal_unit(Dimension dimension)
{
    const Known* entry = known(dimension);
    return entry ? entry->unit : std::string_view{};
}

DimensionResult apply_rule(BuiltinId id, std::span<const Dimension> arguments)
{
    const std::string_view rule = all_builtins()[static_cast<size_t>(id)].dimensions;
    const size_t open = rule.find('(');
    std::string_view rest = rule.substr(open + 1, rule.size() - open - 2);
    Letters letters{Dimension::any(), Dimension::any(), Dimension::any()};
    DimensionResult made;
    for (size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view term = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), term.size() + 1));
        const Dimension expected = evaluate(term, letters);
        const auto both = join(expected, arguments[i]);
        const bool is_letter = term.size() == 1 && term != "1";
        if (!both && made.fits) made = {Dimension::any(), false, i, expected, is_letter};
        if (is_letter) letters[static_cast<size_t>(term.front() - 'a')] = both.value_or(Dimension::any());
    }
    made.result = evaluate(rule.substr(0, open), letters);
    return made;
}

} // namespace haptel::lang
