#include "input/kept_files.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace haptel::input {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view unfinished = "unfinished-";
constexpr uint32_t stores_per_trim = 64; // the first of a process is one, and what is large
constexpr auto abandoned_after = std::chrono::hours(1);

struct Entry {
    fs::path path;
    fs::file_time_type used;
    uint64_t bytes;
};

// What is kept; and what a process that died has left behind goes.
std::vector<Entry> entries_of(const fs::path& folder, const std::string& ending)
{
    std::vector<Entry> entries;
    std::error_code error;
    fs::directory_iterator each(folder, error);
    for (const fs::directory_iterator end; !error && each != end; each.increment(error)) {
        const std::string name = each->path().filename().string();
        const bool is_kept = name.ends_with(ending), is_unfinished = name.starts_with(unfinished);
        std::error_code gone; // another process may be at work here
        if ((!is_kept && !is_unfinished) || !each->is_regular_file(gone)) continue;
        const Entry entry{each->path(), each->last_write_time(gone), each->file_size(gone)};
        if (gone) continue;
        if (is_kept)
            entries.push_back(entry);
        else if (fs::file_time_type::clock::now() - entry.used > abandoned_after)
            fs::remove(entry.path, gone);
    }
    return entries;
}

// With those above it, for its owner alone.
void make_folder(const fs::path& folder)
{
    fs::path made;
    for (const fs::path& step : folder) mkdir((made /= step).c_str(), S_IRWXU);
}

bool write_all(int file, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = write(file, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

} // namespace

KeptFiles::KeptFiles(fs::path folder, std::string ending, uint64_t limit_bytes)
    : folder_(std::move(folder)), ending_(std::move(ending)), limit_bytes_(limit_bytes)
{
}

fs::path KeptFiles::folder_of_environment()
{
    const auto value = [](const char* name) {
        const char* const found = std::getenv(name);
        return std::string(found ? found : "");
    };
    if (const std::string chosen = value("HAPTEL_CACHE"); !chosen.empty()) return chosen == "off" ? "" : chosen;
    // A relative path would be another folder for every working directory.
    if (const fs::path base = value("XDG_CACHE_HOME"); base.is_absolute()) return base / "haptel";
    if (const fs::path home = value("HOME"); home.is_absolute()) return home / ".cache" / "haptel";
    return {};
}

// What lies in a folder where others can write may be anybody's.
std::string KeptFiles::fault() const
{
    struct stat found = {};
    if (folder_.empty()) return "switched off";
    if (stat(folder_.c_str(), &found) != 0) return std::strerror(errno);
    if (!S_ISDIR(found.st_mode)) return "not a folder";
    if (found.st_uid != geteuid()) return "it belongs to somebody else";
    if ((found.st_mode & (S_IWGRP | S_IWOTH)) != 0) return "others can write there";
    return {};
}

int KeptFiles::open(const std::string& name) const
{
    if (!fault().empty()) return -1;
    // Not through a link, and without waiting for the other end of a pipe.
    const int file = ::open((folder_ / (name + ending_)).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    struct stat found = {};
    if (file < 0) return -1;
    if (fstat(file, &found) == 0 && S_ISREG(found.st_mode) && found.st_uid == geteuid()) {
        futimens(file, nullptr); // used now
        return file;
    }
    close(file);
    return -1;
}

void KeptFiles::store(const std::string& name, std::span<const std::string_view> pieces)
{
    uint64_t bytes = 0;
    for (const std::string_view piece : pieces) bytes += piece.size();
    if (folder_.empty() || bytes > limit_bytes_ / 4 * 3) return;
    make_folder(folder_);
    if (!fault().empty()) return;
    std::string making = (folder_ / unfinished).string() + "XXXXXX";
    const int file = mkostemp(making.data(), O_CLOEXEC);
    if (file < 0) return;
    const bool written =
        std::all_of(pieces.begin(), pieces.end(), [&](std::string_view piece) { return write_all(file, piece); });
    const bool closed = close(file) == 0;
    if (!written || !closed || rename(making.c_str(), (folder_ / (name + ending_)).c_str()) != 0)
        unlink(making.c_str());
    if (stored_++ % stores_per_trim == 0 || bytes > limit_bytes_ / stores_per_trim) trim();
}

void KeptFiles::trim() const
{
    std::vector<Entry> entries = entries_of(folder_, ending_);
    uint64_t bytes = 0;
    for (const Entry& entry : entries) bytes += entry.bytes;
    if (bytes <= limit_bytes_) return;
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
    for (const Entry& entry : entries) {
        if (bytes <= limit_bytes_ / 4 * 3) break;
        std::error_code gone;
        fs::remove(entry.path, gone);
        bytes -= entry.bytes;
    }
}

KeptFiles::Status KeptFiles::status() const
{
    Status status{folder_.string(), fault(), 0, 0, limit_bytes_};
    for (const Entry& entry : entries_of(folder_, ending_)) {
        ++status.files;
        status.bytes += entry.bytes;
    }
    return status;
}

uint64_t KeptFiles::clear()
{
    uint64_t gone = 0;
    std::error_code ignored;
    for (const Entry& entry : entries_of(folder_, ending_)) gone += fs::remove(entry.path, ignored);
    return gone;
}

} // namespace haptel::input
