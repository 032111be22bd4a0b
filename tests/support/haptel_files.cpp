#include "tests/support/haptel_files.h"

#include "tests/support/project_path.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cstdlib>

namespace haptel::test {

std::vector<std::filesystem::path> haptel_files(const std::vector<std::string>& folders)
{
    std::vector<std::filesystem::path> files;
    for (const std::string& folder : folders)
        for (const auto& entry : std::filesystem::directory_iterator(project_path(folder)))
            if (entry.path().extension() == ".haptel") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::filesystem::path> texture_files(const std::vector<std::string>& folders)
{
    const bool are_all = !is_sanitized && !std::getenv("HAPTEL_ISA");
    const std::vector<std::filesystem::path> files = haptel_files(folders);
    std::vector<std::filesystem::path> some;
    for (size_t i = 0; i < files.size(); i += are_all ? 1 : 10) some.push_back(files[i]);
    return some;
}

std::vector<std::filesystem::path> all_texture_files()
{
    std::vector<std::string> folders = {"stdlib/tests", "examples/textures"};
    for (const char* family :
         {"fabric", "food", "leather", "metal", "paper", "perception", "plastic", "skin", "stone", "wood"})
        folders.push_back("materials/" + std::string(family));
    return texture_files(folders);
}

} // namespace haptel::test
