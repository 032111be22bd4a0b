// The functions of GLSL text that are no texture's: elementary functions, and what an operation of the IR means where
// GLSL has no operator for it, or one of less precision than f32 (its sine may be off by 2^-11).
#pragma once

#include <string>
#include <string_view>

namespace haptel::emit_glsl {

// Of these functions those that `text` calls, with what they call, callees first. Each stands in an #ifndef of its own,
// so that several texts may stand in one shader.
std::string helpers_for(std::string_view text);

} // namespace haptel::emit_glsl
