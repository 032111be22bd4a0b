// Texture files on disk. lang performs no I/O: this is where text comes from.
#pragma once

#include "lang/compile.h"

#include <string>
#include <string_view>

namespace haptel::jit {

struct SourceText {
    std::string text;
    std::string error; // why there is no text; empty: there is
    std::string hint;
};

// Whole text of a regular file of at most source_bytes_max.
SourceText read_source(const std::string& path);
inline constexpr size_t source_bytes_max = 16u << 20;

// lang::ImportLoader: `path` is relative to the file that imports it, or names a file of an installed library.
lang::Imported load_beside(std::string_view path, std::string_view importer);

// "rock.haptel:rock" taken apart; `texture` is empty where the reference is a path alone. "wood.oak:board" is of the
// library that a file in `folder` would import; the name stays where there is none.
struct TextureReference {
    std::string file, texture;
};
TextureReference split_reference(std::string_view reference, const std::string& folder = {});

// Messages of a line each, and hints set in below them, as messages about that file.
std::string about_file(const std::string& file, std::string_view messages);

} // namespace haptel::jit
