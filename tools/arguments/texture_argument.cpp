#include "tools/arguments/texture_argument.h"

#include "lang/abi/library_name.h"
#include "lang/parameter_value.h"
#include "libraries/find.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace haptel::tools {

Parsed<TextureArgument> parse_texture_argument(std::string_view text)
{
    const auto colon = text.rfind(':');
    if (colon == text.npos && names_library_file(text))
        return {{libraries::path_named(text), std::string(texture_called_like(text))}, {}};
    if (colon == text.npos || colon == 0 || colon + 1 == text.size())
        return {{}, fmt::format("expected FILE:NAME, such as rock.haptel:rock, found '{}'", text)};
    return {{libraries::path_named(text.substr(0, colon)), std::string(text.substr(colon + 1))}, {}};
}

CLI::Option* add_texture(CLI::App& app, TextureArgument& texture)
{
    return app
        .add_option_function<std::string>(
            "texture",
            [&texture](const std::string& text) {
                Parsed<TextureArgument> argument = parse_texture_argument(text);
                if (!argument) throw CLI::ValidationError(argument.error);
                texture = std::move(argument.value);
            },
            "A texture of a file")
        ->required()
        ->type_name("FILE:NAME");
}

CLI::Option* add_parameters(CLI::App& app, ParameterTexts& parameters)
{
    return app
        .add_option_function<std::vector<std::string>>(
            "--set",
            [&parameters](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    const auto equals = text.find('=');
                    if (equals == text.npos || equals == 0 || equals + 1 == text.size())
                        throw CLI::ValidationError(
                            fmt::format("--set: expected name=value, such as depth=60um, found '{}'", text));
                    parameters.emplace_back(text.substr(0, equals), text.substr(equals + 1));
                }
            },
            "Value of a parameter; may be repeated")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
}

TextureRequest request_in_cube(double side_m, double footprint_m)
{
    TextureRequest request;
    std::fill_n(request.box_minimum_m, 3, -side_m / 2);
    std::fill_n(request.box_maximum_m, 3, side_m / 2);
    request.footprint_m = footprint_m;
    return request;
}

ParameterTexts values_for(const ir::Texture& texture, const ParameterTexts& all)
{
    ParameterTexts taken;
    std::ranges::copy_if(all, std::back_inserter(taken),
                         [&](const auto& value) { return !lang::parameters_called(value.first, texture).empty(); });
    return taken;
}

} // namespace haptel::tools
