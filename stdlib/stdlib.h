// The standard library as text, embedded at build time. Whoever compiles hands it to the compiler as an argument.
#pragma once

#include <span>
#include <string_view>

namespace haptel::stdlib {

struct LibraryFile {
    std::string_view name; // "noise.haptel"
    std::string_view text;
};

std::span<const LibraryFile> library();

// Textures that try the library's functions, one or more for each: examples for people.
std::span<const LibraryFile> tests();

} // namespace haptel::stdlib
