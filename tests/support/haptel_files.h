// The files of the project that are written in Haptel, for tests that hold for every one of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace haptel::test {

// Every .haptel file that stands in one of the folders, which are named from the project's root; in order.
std::vector<std::filesystem::path> haptel_files(const std::vector<std::string>& folders);

// The library's textures and the examples', for tests of what compiled code computes. Only every tenth file where the
// program is sanitized, for that code is not, only what compiles it, which is then slow; and where an instruction set
// is chosen, for the operations are compared with the interpreter on each.
std::vector<std::filesystem::path> texture_files(const std::vector<std::string>& folders = {"stdlib/tests",
                                                                                            "examples/textures"});

// Those, and the materials'.
std::vector<std::filesystem::path> all_texture_files();

} // namespace haptel::test
