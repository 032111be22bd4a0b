// Runs the built haptel command as a user would, and keeps what it said.
#pragma once

#include "tests/support/folder.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

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
inline Ran run_command(const std::string& arguments, const std::string& before = "")
{
    const Folder folder;
    const std::string line = before + " '" HAPTEL_COMMAND "' " + arguments + " 2>'" + folder.file("err") + "'";
    Ran ran;
    FILE* pipe = popen(line.c_str(), "r");
    if (!pipe) return ran;
    std::array<char, 4096> block;
    while (const std::size_t count = fread(block.data(), 1, block.size(), pipe)) ran.out.append(block.data(), count);
    const int status = pclose(pipe);
    ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ran.err = read_file(folder.file("err"));
    return ran;
}

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace haptel::test
