// The files of this folder.
#pragma once

#include "tests/support/project_path.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace haptel::lang::test {

struct CaseFile {
    std::string name; // "numbers/hex"
    std::string text;
};

inline std::vector<CaseFile>
case_files(const std::string& folder = haptel::test::project_path("tests/conformance/cases"))
{
    std::vector<CaseFile> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".haptel") continue;
        std::ifstream file(entry.path(), std::ios::binary);
        std::stringstream text;
        text << file.rdbuf();
        files.push_back({std::filesystem::relative(entry.path(), folder).replace_extension().string(), text.str()});
    }
    std::ranges::sort(files, {}, &CaseFile::name);
    return files;
}

} // namespace haptel::lang::test
