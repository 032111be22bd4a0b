// How a command line names one texture and its parameters' values: FILE:NAME and --set name=value.
#pragma once

#include "lang/abi/texture_binding.h"
#include "lang/ir/ir.h"
#include "tools/arguments/quantity.h"

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

namespace haptel::tools {

struct TextureArgument {
    std::string file, name;
};

// At the last colon; both sides must be there, but for the file of an installed library, "wood.oak", which becomes its
// path and is enough for the texture `oak`.
Parsed<TextureArgument> parse_texture_argument(std::string_view text);

// What TextureRequest::parameters wants: text stays text.
using ParameterTexts = std::vector<std::pair<std::string, std::string>>;

// The positional argument FILE:NAME; misuse where it is not of that form.
CLI::Option* add_texture(CLI::App& app, TextureArgument& texture);

// --set name=value, any number of times.
CLI::Option* add_parameters(CLI::App& app, ParameterTexts& parameters);

// What is asked of a texture in a cube of that side round the origin.
TextureRequest request_in_cube(double side_m, double footprint_m = 0);

// Each texture takes the values whose names it has.
ParameterTexts values_for(const ir::Texture& texture, const ParameterTexts& all);

} // namespace haptel::tools
