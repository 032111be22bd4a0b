#include "lang/parameter_value.h"

#include "lang/text/near_name.h"
#include "lang/text/number.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace haptel::lang {

namespace {

std::string_view trimmed(std::string_view text)
{
    const size_t first = text.find_first_not_of(" \t");
    return first == text.npos ? std::string_view{} : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// What values of this unit look like, for messages.
std::string expected_number(std::string_view si)
{
    if (si == "m") return "a length such as 0.5mm or 60um";
    if (si == "rad") return "an angle such as 30deg";
    if (si == "s") return "a time such as 5ms";
    if (si == "Hz") return "a frequency such as 250Hz";
    return "a plain number";
}

std::string shortest(double value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

ParameterValue fail(std::string error, std::string hint = {})
{
    return {0, std::move(error), std::move(hint)};
}

ParameterValue read_whole(std::string_view text, double value, const Number& number, const ir::Parameter& parameter)
{
    const bool is_signed = parameter.type == ir::Type::i32;
    const double low = std::fmax(parameter.minimum, is_signed ? -2147483648.0 : 0.0);
    const double high = std::fmin(parameter.maximum, is_signed ? 2147483647.0 : 4294967295.0);
    const std::string range = "a whole number in " + shortest(low) + " .. " + shortest(high);
    if (number.kind == Number::Kind::real || !number.unit.empty())
        return fail("expected " + range + ", found '" + printable(text) + "'");
    if (value < low || value > high) return fail(printable(text) + " is outside its range: expected " + range);
    return {value == 0 ? 0 : value};
}

ParameterValue read_real(std::string_view text, double value, const Number& number, const ir::Parameter& parameter)
{
    if (!number.unit.empty() && si_unit(number.unit) != parameter.unit)
        return fail("expected " + expected_number(parameter.unit) + ", found '" + printable(text) + "'");
    ParameterValue read{value};
    if (value < parameter.minimum || value > parameter.maximum)
        read.warning = printable(text) + " is outside of its range " + shortest(parameter.minimum) + " .. " +
                       shortest(parameter.maximum) + (parameter.unit.empty() ? "" : " " + parameter.unit);
    return read;
}

// Of a parameter whose values have names. A number does as well.
ParameterValue read_choice(std::string_view text, const ir::Parameter& parameter)
{
    const std::vector<std::string>& choices = parameter.choices;
    const auto named = std::ranges::find(choices, text);
    if (named != choices.end()) return {static_cast<double>(named - choices.begin())};
    std::string all;
    for (size_t i = 0; i < choices.size(); ++i)
        all += (i == 0 ? "" : i + 1 < choices.size() ? ", " : " or ") + choices[i];
    const NearName near = near_name(text, {choices.begin(), choices.end()});
    return fail("expected " + all + ", found '" + printable(text) + "'",
                near.name.empty() ? "" : "did you mean '" + std::string(near.name) + "'?");
}

} // namespace

ParameterValue parse_value(std::string_view text, const ir::Parameter& parameter)
{
    text = trimmed(text);
    if (parameter.type == ir::Type::image) // whoever reads files knows more
        return text.empty() ? fail("expected the name of a picture's file") : ParameterValue{};
    if (parameter.type == ir::Type::boolean)
        return text == "true" || text == "false" ? ParameterValue{text == "true" ? 1.0 : 0.0}
                                                 : fail("expected true or false, found '" + printable(text) + "'");
    const bool is_number = !text.empty() && std::string_view("+-0123456789").find(text[0]) != std::string_view::npos;
    if (!is_number && !parameter.choices.empty()) return read_choice(text, parameter);
    const bool has_sign = !text.empty() && (text[0] == '-' || text[0] == '+');
    std::string digits(text.substr(has_sign));
    const size_t blank = digits.find_first_of(" \t"); // "60 um"
    if (blank != digits.npos) digits.erase(blank, digits.find_first_not_of(" \t", blank) - blank);
    const Number number = read_number(digits);
    if (!number.error.empty())
        return fail(number.code == "unknown-unit" ? number.error : number.error + ", found '" + printable(text) + "'",
                    number.hint);
    const double value = has_sign && text[0] == '-' ? -number.value : number.value;
    return parameter.type == ir::Type::real ? read_real(text, value, number, parameter)
                                            : read_whole(text, value, number, parameter);
}

std::span<const ir::Parameter> parameters_called(std::string_view name, const ir::Texture& texture)
{
    const auto is_called = [&](const ir::Parameter& parameter) {
        const std::string_view whole = parameter.name;
        return whole == name || (whole.starts_with(name) && whole.substr(name.size()).starts_with('.'));
    };
    const auto first = std::ranges::find_if(texture.parameters, is_called);
    return {first, std::find_if_not(first, texture.parameters.end(), is_called)};
}

ParameterValues parse_values(std::string_view name, std::string_view text, const ir::Texture& texture)
{
    ParameterValues read{parameters_called(name, texture)};
    const size_t count = read.parameters.size();
    if (count == 1) read.values = {parse_value(text, read.parameters[0])};
    if (count <= 1) return read;
    std::vector<std::string_view> parts;
    for (size_t begin = 0; begin <= text.size(); begin += parts.back().size() + 1)
        parts.push_back(text.substr(begin, text.find(',', begin) - begin));
    if (parts.size() != count) {
        std::string example;
        for (const ir::Parameter& parameter : read.parameters)
            example += (example.empty() ? "" : ", ") + shortest(parameter.value);
        read.values = {fail("expected " + std::to_string(count) + " numbers, found '" + printable(text) + "'",
                            "write them with commas between: " + example)};
        return read;
    }
    for (size_t i = 0; i < count; ++i) {
        ParameterValue value = parse_value(parts[i], read.parameters[i]);
        if (!value.error.empty()) {
            read.values = {std::move(value)};
            return read;
        }
        read.values.push_back(std::move(value));
    }
    return read;
}

std::vector<std::string> parameter_names(const ir::Texture& texture)
{
    std::vector<std::string> names;
    for (const ir::Parameter& parameter : texture.parameters) {
        const std::string whole = parameter.name.substr(0, parameter.name.find('.'));
        if (whole != parameter.name && std::ranges::find(names, whole) == names.end()) names.push_back(whole);
        names.push_back(parameter.name);
    }
    return names;
}

} // namespace haptel::lang
