// The files of the project that are written in Haptel, for tests that hold for every one of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace haptel::test {

// Every .haptel file that stands in one of the folders, which are named from the project's root; in order.
std::vector<std::filesystem::path> haptel_files(const std::vector<std::string>& folders);

// The library's textures and the examples', for tests of what compiled code computes. That code is not sanitized, only
// what compiles it, and that is slow: then every third file is enough.
std::vector<std::filesystem::path> texture_files();

} // namespace haptel::test
