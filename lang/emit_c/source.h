// Textures as one file of C99 (which C++ compilers read, too): no heap, no recursion, no files but the C library's
// headers, and what it costs at most in a comment on top.
//
// In double it has the bits of the interpreter, the elementary functions included, on any compiler that does not fuse
// or reassociate (-std=c99, or -ffp-contract=off; never -ffast-math). In float everything but angles and powers is
// computed in float; what comes in and goes out is double, as in all compiled textures.
#pragma once

#include "lang/emit_c/library.h"

#include <span>
#include <string>
#include <string_view>

namespace haptel::emit_c {

// The header's declarations are a part of it. Batch entries are absent.
std::string source(std::string_view name, std::span<const LibraryTexture> textures, bool is_single);

} // namespace haptel::emit_c
