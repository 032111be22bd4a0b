// Texture files as a command line names them: files, FILE:NAME, and folders of them.
#pragma once

#include <string>
#include <tuple>
#include <vector>

namespace haptel::tools {

// A texture file, and one texture of it if only that is meant.
struct TextureTarget {
    std::string file, texture;
    bool operator<(const TextureTarget& other) const
    {
        return std::tie(file, texture) < std::tie(other.file, other.texture);
    }
};

// Folders stand for the texture files in them, at any depth, by name. Files of functions alone, which are for others to
// import, are left out where they are not wanted.
std::vector<TextureTarget> texture_targets(const std::vector<std::string>& paths, bool of_functions_too = false);

} // namespace haptel::tools
