// Libraries that are right, as text and on disk, for tests to change in one place.
#pragma once

#include "libraries/package/package.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace haptel::test {

using namespace libraries;

inline bool says(const std::string& text, const std::string& part)
{
    return text.find(part) != text.npos;
}

inline std::string manifest_text(const std::string& name, const std::string& version, const std::string& more = "")
{
    return "schema = 1\nname = \"" + name + "\"\nversion = \"" + version +
           "\"\ntagline = \"For tests\"\nauthors = [\"A. Tester\"]\nlicense = \"CC0-1.0\"\ntextures = "
           "[\"oak:board\"]\n" +
           more;
}

// oak.haptel with a texture "board" of this height, a number.
inline Contents library_files(const std::string& name, const std::string& version, const std::string& height = "1mm",
                              const std::string& more = "")
{
    return {{manifest_name, manifest_text(name, version, more)},
            {"oak.haptel", "/// Flat.\ntexture board() { return " + height + "; }\n"}};
}

inline Package library(const std::string& name, const std::string& version, const std::string& height = "1mm",
                       const std::string& more = "")
{
    return make_package(library_files(name, version, height, more), name).package.value();
}

inline void write_files(const Contents& contents, const std::filesystem::path& folder)
{
    for (const auto& [path, bytes] : contents) {
        std::filesystem::create_directories((folder / path).parent_path());
        std::ofstream(folder / path, std::ios::binary) << bytes;
    }
}

} // namespace haptel::test
