// The textures of examples/textures, embedded: what people write.
#pragma once

#include "stdlib/stdlib.h"

namespace haptel::stdlib {

std::span<const LibraryFile> example_textures();

} // namespace haptel::stdlib
