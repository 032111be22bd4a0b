#include "tools/output/replace_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace haptel::tools {

namespace {

bool write_all(int file, std::string_view text)
{
    while (!text.empty()) {
        const ssize_t count = write(file, text.data(), text.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        text.remove_prefix(static_cast<size_t>(count));
    }
    return true;
}

} // namespace

std::string replace_file(const std::string& path, std::string_view text)
{
    std::error_code error;
    const std::string target = std::filesystem::canonical(path, error);
    struct stat before = {};
    if (error) return error.message();
    if (stat(target.c_str(), &before) != 0 || access(target.c_str(), W_OK) != 0) return std::strerror(errno);

    std::string beside = target + ".XXXXXX"; // in the same folder: only there a rename is one step
    const int file = mkstemp(beside.data());
    if (file < 0) return std::strerror(errno);
    const bool is_written = write_all(file, text) && fchmod(file, before.st_mode & 07777) == 0 && fsync(file) == 0;
    int fault = is_written ? 0 : errno;
    if (close(file) != 0 && fault == 0) fault = errno;
    if (fault == 0 && std::rename(beside.c_str(), target.c_str()) != 0) fault = errno;
    if (fault == 0) return {};
    unlink(beside.c_str());
    return std::strerror(fault);
}

} // namespace haptel::tools
