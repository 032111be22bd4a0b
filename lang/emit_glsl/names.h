// Numbers and names as GLSL reads them.
#pragma once

#include "lang/ir/ir.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::emit_glsl {

// Rounded to float; behind a sign in parentheses.
std::string literal(double value);

// Textures as parts of names (haptel_height_NAME), by index: no two alike, and no "__", which GLSL keeps for itself.
std::vector<std::string> texture_names(std::span<const ir::Texture* const> textures);

// The parameters as members of their texture's block, by index; size.x is size_x. With a '_' behind
// it where it is reserved.
std::vector<std::string> member_names(const ir::Texture& texture);

} // namespace haptel::emit_glsl
