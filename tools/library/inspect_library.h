// Whether a library is fit to be published: each texture that it names compiles, has a doc comment, passes what `haptel
// test` tests, and is held to a promise by a test of its own; and pictures of them.
//
// A test of the texture board of oak.haptel is the texture board of tests/oak.haptel. It says what must hold by being
// flat: its height is 0 everywhere, to 1 nm.
#pragma once

#include "libraries/package/package.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace haptel::tools {

struct InspectedTexture {
    std::string file, name, doc, preview; // oak.haptel, board, its doc comment, previews/oak/board.png
    std::string called;                   // wood.oak:board
};

struct LibraryInspection {
    std::vector<std::string> problems; // "wood/oak.haptel: error: ...", a line each
    std::vector<InspectedTexture> textures;
    libraries::Contents previews; // by path
};

inline constexpr const char* previews_folder = "previews/";
inline constexpr double preview_m = 0.03; // how wide a picture is where `previews` of library.toml does not say

// `folder` is the library's; `progress` hears the share that is done. What the compiler says goes to standard error.
LibraryInspection inspect_library(const libraries::Manifest& manifest, const libraries::Contents& contents,
                                  const std::filesystem::path& folder, const std::function<void(double)>& progress);

} // namespace haptel::tools
