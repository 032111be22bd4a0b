// A library's own tests: textures in its folder tests/ that are flat where what they test holds.
#pragma once

#include "jit/texture/texture.h"

#include <filesystem>
#include <memory>
#include <string>

namespace haptel::tools {

inline constexpr const char* tests_folder = "tests/";
inline constexpr double library_box_m = 0.05; // side of the cube where points are tried, as of haptel test

// Whether the file is in tests/ of a folder with a library.toml.
bool is_library_test(const std::filesystem::path& file);

// Why the test does not hold, in words; empty: it is flat, to 1 nm, wherever it is tried.
std::string why_not_held(const std::shared_ptr<const jit::CompiledProgram>& tests, const std::string& name);

} // namespace haptel::tools
