// Textures of any length to measure the compiler with.
#pragma once

#include <cstdint>
#include <string>

namespace haptel::bench {

// A texture of about so many lines, at least 40, written as people do: functions of a dozen lines with loops, noise,
// vectors and a doc comment each, all called by one texture `field`.
std::string generated_texture(uint32_t lines);

} // namespace haptel::bench
