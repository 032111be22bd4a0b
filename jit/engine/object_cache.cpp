#include "jit/engine/object_cache.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <llvm/Support/MemoryBuffer.h>
#include <llvm/Support/raw_ostream.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace haptel::jit {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "haptel object 1\n", ending = ".object", unfinished = "unfinished-";
constexpr uint64_t object_max = uint64_t{64} << 20; // of code for textures, a thousand times what is usual
constexpr uint32_t stores_per_trim = 64;            // the first of a process is one
constexpr auto abandoned_after = std::chrono::hours(1);

std::string_view bytes_of(const ContentHash& hash)
{
    return {reinterpret_cast<const char*>(hash.data()), hash.size()};
}

// Magic, key, checksum, object. The checksum is over key and object.
std::string head_of(const ContentHash& key, std::string_view object)
{
    std::string checked(bytes_of(key));
    checked += object;
    return std::string(magic).append(bytes_of(key)).append(bytes_of(content_hash(checked)));
}
constexpr size_t head_size = magic.size() + 2 * sizeof(ContentHash);

// Of an open file; nothing where it is not ours, or damaged.
std::optional<std::string> object_in(int file, const ContentHash& key)
{
    struct stat found = {};
    if (fstat(file, &found) != 0 || !S_ISREG(found.st_mode) || found.st_uid != geteuid()) return {};
    const auto size = static_cast<uint64_t>(found.st_size);
    if (size < head_size || size > object_max) return {};
    const auto bytes = llvm::MemoryBuffer::getOpenFile(file, "", size, false, true); // not mapped: it may be cut short
    if (!bytes) return {};
    const std::string_view whole = (*bytes)->getBuffer(), object = whole.substr(head_size);
    if (whole.substr(0, head_size) != head_of(key, object)) return {};
    return std::string(object);
}

fs::path folder_of_environment()
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

struct Entry {
    fs::path path;
    fs::file_time_type used;
    uint64_t bytes;
};

// Objects, and what a process that died has left behind.
std::vector<Entry> entries_of(const fs::path& folder)
{
    std::vector<Entry> entries;
    std::error_code error;
    fs::directory_iterator each(folder, error);
    for (const fs::directory_iterator end; !error && each != end; each.increment(error)) {
        const std::string name = each->path().filename().string();
        const bool is_object = name.ends_with(ending), is_unfinished = name.starts_with(unfinished);
        std::error_code gone; // another process may be at work here
        if ((!is_object && !is_unfinished) || !each->is_regular_file(gone)) continue;
        const Entry entry{each->path(), each->last_write_time(gone), each->file_size(gone)};
        if (gone) continue;
        if (is_object)
            entries.push_back(entry);
        else if (fs::file_time_type::clock::now() - entry.used > abandoned_after)
            fs::remove(entry.path, gone);
    }
    return entries;
}

} // namespace

ObjectCache::ObjectCache(fs::path chosen, uint64_t limit) : folder(std::move(chosen)), limit_bytes(limit) {}

ObjectCache& ObjectCache::shared()
{
    static auto* cache = new ObjectCache(folder_of_environment()); // code is compiled as long as the process lives
    return *cache;
}

fs::path ObjectCache::place_of(const ContentHash& key) const
{
    return folder / (to_text(key) + std::string(ending));
}

// What lies in a folder where others can write may be anybody's code.
std::string ObjectCache::fault() const
{
    struct stat found = {};
    if (folder.empty()) return "switched off";
    if (stat(folder.c_str(), &found) != 0) return std::strerror(errno);
    if (!S_ISDIR(found.st_mode)) return "not a folder";
    if (found.st_uid != geteuid()) return "it belongs to somebody else";
    if ((found.st_mode & (S_IWGRP | S_IWOTH)) != 0) return "others can write there";
    return {};
}

std::optional<std::string> ObjectCache::load(const ContentHash& key) const
{
    if (!fault().empty()) return std::nullopt;
    // Not through a link, and without waiting for the other end of a pipe.
    const int file = open(place_of(key).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) return std::nullopt;
    std::optional<std::string> object = object_in(file, key);
    if (object) futimens(file, nullptr); // used now
    close(file);
    return object;
}

void ObjectCache::store(const ContentHash& key, std::string_view object)
{
    if (folder.empty() || object.size() + head_size > object_max) return;
    std::error_code ignored;
    if (fs::create_directories(folder, ignored)) chmod(folder.c_str(), S_IRWXU);
    if (!fault().empty()) return;
    std::string name = (folder / unfinished).string() + "XXXXXX";
    const int file = mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) return;
    llvm::raw_fd_ostream out(file, true);
    out << head_of(key, object) << object;
    out.close();
    if (out.has_error() || rename(name.c_str(), place_of(key).c_str()) != 0) unlink(name.c_str());
    out.clear_error(); // else it would end the process
    if (stored++ % stores_per_trim == 0) trim();
}

void ObjectCache::trim() const
{
    std::vector<Entry> entries = entries_of(folder);
    uint64_t bytes = 0;
    for (const Entry& entry : entries) bytes += entry.bytes;
    if (bytes <= limit_bytes) return;
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
    for (const Entry& entry : entries) {
        if (bytes <= limit_bytes / 4 * 3) break;
        std::error_code gone;
        fs::remove(entry.path, gone);
        bytes -= entry.bytes;
    }
}

ObjectCache::Status ObjectCache::status() const
{
    Status status{folder.string(), fault(), 0, 0, limit_bytes};
    for (const Entry& entry : entries_of(folder)) {
        ++status.objects;
        status.bytes += entry.bytes;
    }
    return status;
}

uint64_t ObjectCache::clear()
{
    uint64_t gone = 0;
    std::error_code ignored;
    for (const Entry& entry : entries_of(folder)) gone += fs::remove(entry.path, ignored);
    return gone;
}

} // namespace haptel::jit
