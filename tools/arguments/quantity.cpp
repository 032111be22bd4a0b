#include "tools/arguments/quantity.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace haptel::tools {

namespace {

constexpr std::pair<std::string_view, int> units[] = {
    {"", 0},    {"m", 0},        {"cm", -2},      {"mm", -3},
    {"um", -6}, {"\u00b5m", -6}, {"\u03bcm", -6}, {"nm", -9}}; // both code points that look like a Greek mu

std::string_view trimmed(std::string_view text)
{
    const auto first = text.find_first_not_of(" \t");
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Length of the number at the start of `text`, 0 if there is none.
std::size_t number_length(std::string_view text)
{
    double ignored = 0;
    const std::size_t sign = text.starts_with('+') && !text.starts_with("+-"); // from_chars knows no plus
    const auto [end, error] = std::from_chars(text.data() + sign, text.data() + text.size(), ignored);
    return error == std::errc::invalid_argument ? 0 : static_cast<std::size_t>(end - text.data());
}

// The double nearest to `number` (as measured by number_length) times 10^exponent.
double scaled(std::string_view number, int exponent)
{
    if (number[0] == '+') number.remove_prefix(1);
    const auto e = number.find_first_of("eE");
    int64_t written = 0;
    if (e != number.npos) {
        const char* digits = number.data() + e + 1;
        if (*digits == '+') ++digits;
        if (std::from_chars(digits, number.data() + number.size(), written).ec != std::errc()) return HUGE_VAL;
    }
    const std::string text = fmt::format("{}e{}", number.substr(0, e), written + exponent);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() ? value : HUGE_VAL;
}

template <int size, typename Parse>
Parsed<std::array<double, size>> parse_list(std::string_view text, Parse&& parse, std::string_view form)
{
    Parsed<std::array<double, size>> result;
    std::size_t count = 0;
    for (std::string_view rest = text;; rest.remove_prefix(rest.find(',') + 1)) {
        const Parsed<double> item = parse(rest.substr(0, rest.find(',')));
        if (!item) return {{}, fmt::format("expected {}, found '{}': {}", form, text, item.error)};
        if (count < size) result.value[count] = item.value;
        ++count;
        if (rest.find(',') == rest.npos) break;
    }
    if (count != size) result.error = fmt::format("expected {}, found {} numbers in '{}'", form, count, text);
    return result;
}

template <typename Vector>
Parsed<Vector> directed(Parsed<Vector> read)
{
    const double length = glm::length(read.value);
    if (read && (!(length > 0) || !std::isfinite(length))) read.error = "it has no direction";
    if (read) read.value /= length;
    return read;
}

} // namespace

Parsed<double> parse_number(std::string_view text)
{
    const std::string_view number = trimmed(text);
    const std::size_t length = number_length(number);
    if (length == 0 || length != number.size()) return {0, fmt::format("expected a number, found '{}'", text)};
    const double value = scaled(number, 0);
    if (!std::isfinite(value)) return {0, fmt::format("'{}' is not a number that can be computed with", text)};
    return {value, {}};
}

Parsed<double> parse_length(std::string_view text)
{
    const std::string_view whole = trimmed(text);
    const std::size_t length = number_length(whole);
    if (length == 0) return {0, fmt::format("expected a length such as 20mm, 0.2m or 0.02 (metres), found '{}'", text)};
    const std::string_view unit = trimmed(whole.substr(length));
    for (const auto& [name, exponent] : units) {
        if (name != unit) continue;
        const double value = scaled(whole.substr(0, length), exponent);
        if (!std::isfinite(value)) return {0, fmt::format("'{}' is not a length that can be computed with", text)};
        return {value, {}};
    }
    return {0, fmt::format("unknown unit '{}' in '{}': lengths are written in m, cm, mm, um or nm", unit, text)};
}

Parsed<glm::dvec3> parse_point(std::string_view text)
{
    const auto list = parse_list<3>(text, parse_length, "a point x,y,z");
    return {{list.value[0], list.value[1], list.value[2]}, list.error};
}

Parsed<glm::dvec3> parse_vector(std::string_view text)
{
    const auto list = parse_list<3>(text, parse_number, "a vector x,y,z");
    return {{list.value[0], list.value[1], list.value[2]}, list.error};
}

Parsed<glm::dvec2> parse_vector2(std::string_view text)
{
    const auto list = parse_list<2>(text, parse_number, "coordinates u,v");
    return {{list.value[0], list.value[1]}, list.error};
}

Parsed<glm::dvec3> parse_direction(std::string_view text)
{
    return directed(parse_vector(text));
}

Parsed<glm::dvec2> parse_direction2(std::string_view text)
{
    return directed(parse_vector2(text));
}

CLI::Option* add_length(CLI::App& app, const std::string& names, double& metres, const std::string& description,
                        NumberRange range)
{
    return app
        .add_option_function<std::string>(
            names,
            [&metres, range](const std::string& text) {
                const Parsed<double> length = parse_length(text);
                if (!length) throw CLI::ValidationError(length.error);
                if (length.value < 0 || (length.value == 0 && range == NumberRange::positive))
                    throw CLI::ValidationError(fmt::format("a length of '{}' makes no sense here", text));
                metres = length.value;
            },
            description)
        ->type_name("LENGTH");
}

CLI::Option* add_number(CLI::App& app, const std::string& name, std::optional<double>& number,
                        const std::string& description, NumberRange range)
{
    return app.add_option_function<std::string>(
        name,
        [&number, name, range](const std::string& text) {
            const Parsed<double> found = parse_number(text);
            if (!found) throw CLI::ValidationError(name, found.error);
            if (range == NumberRange::positive && found.value <= 0)
                throw CLI::ValidationError(name, fmt::format("expected a number above 0, found '{}'", text));
            if (range == NumberRange::not_negative && found.value < 0)
                throw CLI::ValidationError(name, fmt::format("expected a number of 0 or more, found '{}'", text));
            number = found.value;
        },
        description);
}

} // namespace haptel::tools
