// Numbers and lengths as people write them on the command line: "20mm", "0.2 m", "60um"; a bare number is metres.
//
// A length is the double nearest to the decimal value times its unit, as in the language: "0.2mm" and "0.0002" are the
// same bits.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace haptel::tools {

// A value or, if `error` is not empty, why there is none: what was expected, what was found.
template <typename T>
struct Parsed {
    T value{};
    std::string error;
    explicit operator bool() const { return error.empty(); }
};

Parsed<double> parse_number(std::string_view text);      // finite; nothing but a number
Parsed<double> parse_length(std::string_view text);      // metres
Parsed<glm::dvec3> parse_point(std::string_view text);   // "x,y,z", three lengths
Parsed<glm::dvec3> parse_vector(std::string_view text);  // "x,y,z", three plain numbers
Parsed<glm::dvec2> parse_vector2(std::string_view text); // "u,v"
// Such vectors of length 1, by their direction.
Parsed<glm::dvec3> parse_direction(std::string_view text);
Parsed<glm::dvec2> parse_direction2(std::string_view text);

// An option whose text is parsed so; what cannot be is misuse. `value`: T, or what may be none.
template <typename Value, typename T>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, const std::string& type, Value& value,
                        Parsed<T> (*parse)(std::string_view), const std::string& description)
{
    return app
        .add_option_function<std::string>(
            name,
            [parse, name, &value](const std::string& text) {
                const Parsed<T> parsed = parse(text);
                if (!parsed) throw CLI::ValidationError(name, parsed.error);
                value = parsed.value;
            },
            description)
        ->type_name(type);
}

enum class NumberRange : uint8_t { positive, not_negative };

// An option that takes a length; text that is none, or out of range, is misuse.
CLI::Option* add_length(CLI::App& app, const std::string& names, double& metres, const std::string& description,
                        NumberRange range = NumberRange::positive);

// The same for a plain number, finite; nothing where it is not given.
CLI::Option* add_number(CLI::App& app, const std::string& name, std::optional<double>& number,
                        const std::string& description, NumberRange range);

} // namespace haptel::tools
