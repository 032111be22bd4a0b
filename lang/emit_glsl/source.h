// Textures as functions of GLSL, for the same picture on the screen as under the hand: GLSL ES 3.00 (WebGL 2) and
// later, GLSL 3.30 and later. All is computed in f32; where the version has `precise`, nothing is fused or
// reassociated.
#pragma once

#include "lang/emit_c/library.h"

#include <span>
#include <string>
#include <string_view>

namespace haptel::emit_glsl {

// To stand behind #version in a shader, also beside others of another name. Of texture T it declares the structure
// haptel_block_T, the constant haptel_defaults_T, and the functions haptel_height_T and haptel_height_gradient_T.
std::string source(std::string_view name, std::span<const emit_c::LibraryTexture> textures);

} // namespace haptel::emit_glsl
