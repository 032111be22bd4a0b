#include "input/regular_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace haptel::input {

namespace {

Refused not_opened(int error)
{
    if (error == ENOENT || error == ENOTDIR) return {Refusal::missing, "does not exist"};
    return {Refusal::unreadable, std::string("cannot be read: ") + std::strerror(error)};
}

Refused too_large(uintmax_t bytes, uintmax_t bytes_max)
{
    return {Refusal::too_large,
            "has " + size_in_words(bytes) + ", and at most " + size_in_words(bytes_max) + " are read"};
}

Refused look_at(const struct stat& status, uintmax_t bytes_max)
{
    const mode_t mode = status.st_mode;
    const auto bytes = static_cast<uintmax_t>(std::max<off_t>(status.st_size, 0));
    if (S_ISREG(mode)) return bytes > bytes_max ? too_large(bytes, bytes_max) : Refused{};
    if (S_ISDIR(mode)) return {Refusal::folder, "is a folder"};
    const char* const kind = S_ISFIFO(mode)                   ? "a pipe"
                             : S_ISSOCK(mode)                 ? "a socket"
                             : S_ISCHR(mode) || S_ISBLK(mode) ? "a device"
                                                              : "something else";
    return {Refusal::not_regular, std::string("is ") + kind + ", not a regular file"};
}

} // namespace

std::string size_in_words(uintmax_t bytes)
{
    constexpr std::array<const char*, 5> units = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    auto size = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; size >= 1024 && unit + 1 < units.size(); ++unit) size /= 1024;
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.3g %s", size, units[unit]);
    return text.data();
}

Refused look_at_regular_file(const std::filesystem::path& file, uintmax_t bytes_max)
{
    struct stat status = {};
    return stat(file.c_str(), &status) != 0 ? not_opened(errno) : look_at(status, bytes_max);
}

// By name first: to open a device may do something to it. Then by what was opened: by now the name may stand for
// another file. O_NONBLOCK: a pipe that nobody writes to would wait. O_NOCTTY: a terminal is not to become ours.
RegularFile::RegularFile(const std::filesystem::path& file, uintmax_t bytes_max)
    : refused_(look_at_regular_file(file, bytes_max)), bytes_max_(bytes_max)
{
    if (refused_.refusal != Refusal::none) return;
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    struct stat status = {};
    if (descriptor_ < 0 || fstat(descriptor_, &status) != 0) {
        refused_ = not_opened(errno);
        return;
    }
    refused_ = look_at(status, bytes_max);
    size_bytes_ = static_cast<uintmax_t>(std::max<off_t>(status.st_size, 0));
}

RegularFile::~RegularFile()
{
    if (descriptor_ >= 0) close(descriptor_);
}

std::size_t RegularFile::read(char* to, std::size_t count)
{
    while (refused_.refusal == Refusal::none) {
        const ssize_t got = ::read(descriptor_, to, count);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            refused_ = not_opened(errno);
            break;
        }
        read_ += static_cast<uintmax_t>(got);
        if (read_ <= bytes_max_) return static_cast<std::size_t>(got);
        refused_ = too_large(read_, bytes_max_);
    }
    return 0;
}

FileBytes read_regular_file(const std::filesystem::path& file, uintmax_t bytes_max)
{
    constexpr std::size_t least = 1 << 12;
    RegularFile from(file, bytes_max);
    FileBytes whole;
    if (from.refused().refusal == Refusal::none) {
        // One byte more, so that a file of that size shows its end without more memory.
        whole.bytes.resize(std::max(static_cast<std::size_t>(from.size_bytes()) + 1, least));
        std::size_t size = 0;
        while (const std::size_t got = from.read(whole.bytes.data() + size, whole.bytes.size() - size)) {
            size += got;
            if (size == whole.bytes.size()) whole.bytes.resize(2 * size);
        }
        whole.bytes.resize(size);
    }
    whole.refused = from.refused();
    if (whole.refused.refusal != Refusal::none) whole.bytes = {};
    return whole;
}

} // namespace haptel::input
