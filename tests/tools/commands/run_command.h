// Runs the built haptel command as a user would, and keeps what it said.
#pragma once

#include "tests/support/folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace haptel::test {

inline std::string read_file(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Ran {
    int code = -1; // exit code; 128 + signal if it was killed by one
    std::string out, err;
};

// `arguments` as in a shell: quote what needs it. `before` stands in front of the command: "timeout 5".
Ran run_command(const std::string& arguments, const std::string& before = "");

inline int shell(const std::string& command)
{
    return std::system(command.c_str());
}

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace haptel::test
