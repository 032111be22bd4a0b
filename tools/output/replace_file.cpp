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

std::string put_in_place(const std::string& target, std::string_view text, mode_t mode)
{
    std::string beside = target + ".XXXXXX"; // in the same folder: only there a rename is one step
    const int file = mkstemp(beside.data());
    if (file < 0) return std::strerror(errno);
    const bool is_written = write_all(file, text) && fchmod(file, mode) == 0 && fsync(file) == 0;
    int fault = is_written ? 0 : errno;
    if (close(file) != 0 && fault == 0) fault = errno;
    if (fault == 0 && std::rename(beside.c_str(), target.c_str()) != 0) fault = errno;
    if (fault == 0) return {};
    unlink(beside.c_str());
    return std::strerror(fault);
}

} // namespace

std::string replace_file(const std::string& path, std::string_view text)
{
    std::error_code error;
    const std::string target = std::filesystem::canonical(path, error);
    struct stat before = {};
    if (error) return error.message();
    if (stat(target.c_str(), &before) != 0 || access(target.c_str(), W_OK) != 0) return std::strerror(errno);

    return put_in_place(target, text, before.st_mode & 07777);
}

std::string why_not_written(const std::string& path)
{
    const std::filesystem::path name(path);
    struct stat there = {};
    if (stat(path.c_str(), &there) == 0) {
        if (S_ISDIR(there.st_mode)) return "it is a folder: name a file in it";
        if (!S_ISREG(there.st_mode)) return "it is no regular file";
        return access(path.c_str(), W_OK) == 0 ? "" : std::strerror(errno);
    }
    if (errno != ENOENT) return std::strerror(errno);
    const std::string folder = name.has_parent_path() ? name.parent_path().string() : ".";
    if (stat(folder.c_str(), &there) != 0)
        return errno == ENOENT ? "there is no folder '" + folder + "': make it first" : std::strerror(errno);
    return access(folder.c_str(), W_OK | X_OK) == 0 ? "" : std::strerror(errno);
}

std::string write_file(const std::string& path, std::string_view bytes)
{
    if (std::string why = why_not_written(path); !why.empty()) return why;
    struct stat there = {};
    if (stat(path.c_str(), &there) == 0) return replace_file(path, bytes);
    const mode_t masked = umask(0);
    umask(masked);
    return put_in_place(path, bytes, 0666 & ~masked);
}

} // namespace haptel::tools
