#include "tools/commands/build_shared.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace haptel::tools {

namespace {

namespace fs = std::filesystem;

// Gone with all that is in it.
struct WorkFolder {
    std::string path = (fs::temp_directory_path() / "haptel-build.XXXXXX").string();
    bool is_there = mkdtemp(path.data()) != nullptr;

    WorkFolder() = default;
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder()
    {
        std::error_code ignored;
        if (is_there) fs::remove_all(path, ignored);
    }
};

// What the program said itself stands on standard error. Empty, or why it did not end well.
std::string run_program(const std::vector<std::string>& words)
{
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_t process = 0;
    if (const int fault = posix_spawnp(&process, arguments[0], nullptr, nullptr, arguments.data(), environ))
        return fmt::format(
            "'{}' cannot be started ({}): a shared library is linked by the system's C compiler; install "
            "gcc, or name yours by the environment's CC",
            words[0], std::strerror(fault));
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    return fmt::format(
        "'{}' could not link the library: for another processor's, set CC to that processor's C compiler, "
        "such as CC=aarch64-linux-gnu-gcc",
        words[0]);
}

} // namespace

SharedLibrary link_shared(const std::string& object, const std::string& name)
{
    const WorkFolder folder;
    if (!folder.is_there)
        return {{}, fmt::format("no folder for the work in {}: {}", folder.path, std::strerror(errno))};
    const std::string from = folder.path + "/textures.o", to = folder.path + "/library.so";
    std::ofstream(from, std::ios::binary) << object;
    const char* const chosen = std::getenv("CC");
    // No start files, no build id, nothing of where it was made: equal objects give equal libraries.
    std::string error =
        run_program({chosen && *chosen ? chosen : "cc", "-shared", "-nostartfiles", "-Wl,--build-id=none",
                     "-Wl,-z,defs", "-Wl,--as-needed", "-Wl,-soname," + name, "-o", to, from, "-lm"});
    if (!error.empty()) return {{}, std::move(error)};
    std::ifstream in(to, std::ios::binary);
    return {{std::istreambuf_iterator<char>(in), {}}, {}};
}

} // namespace haptel::tools
