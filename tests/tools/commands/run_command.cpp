#include "tests/tools/commands/run_command.h"

#include <array>
#include <cstdio>
#include <sys/wait.h>

namespace haptel::test {

Ran run_command(const std::string& arguments, const std::string& before)
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

} // namespace haptel::test
