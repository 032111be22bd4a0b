// A picture as shaders read it: words of a texture of type R32UI, which texts with pictures call haptel_images.
#pragma once

#include "lang/abi/abi.h"

#include <cstdint>
#include <vector>

namespace haptel::emit_glsl {

// width, height, channels, levels, channel, level, where the first part begins (0: none), and where the coefficients
// for each HAPTEL_EDGE_* begin, as floats. Parts follow each other.
inline constexpr uint32_t words_of_image = 10;

// Appends the picture and what else there is of it; its place, which a parameter of a block is set to. Place 0 is no
// picture's: what is empty gets one word before. Word i is texel (i % width, i / width) of haptel_images.
int32_t append_image(std::vector<uint32_t>& words, const haptel_image& image);

} // namespace haptel::emit_glsl
