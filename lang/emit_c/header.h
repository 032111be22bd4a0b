// The C header of textures that are compiled ahead of time. It stands alone: the contract with compiled textures
// (lang/abi/abi.h) is a part of it, and it is C99 and C++.
#pragma once

#include "lang/emit_c/library.h"

#include <span>
#include <string>
#include <string_view>

namespace haptel::emit_c {

// `name`: of the library, any text. For each texture the type of its block, a block with the defaults, and its table.
std::string header(std::string_view name, std::span<const LibraryTexture> textures);

} // namespace haptel::emit_c
