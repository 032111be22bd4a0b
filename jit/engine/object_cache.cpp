#include "jit/engine/object_cache.h"

#include <llvm/Support/MemoryBuffer.h>
#include <sys/stat.h>
#include <unistd.h>

namespace haptel::jit {

namespace {

constexpr std::string_view magic = "haptel object 1\n", ending = ".object";
constexpr uint64_t object_max = uint64_t{64} << 20; // of code for textures, a thousand times what is usual

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

// Of an open file; nothing where it is damaged.
std::optional<std::string> object_in(int file, const ContentHash& key)
{
    struct stat found = {};
    if (fstat(file, &found) != 0) return {};
    const auto size = static_cast<uint64_t>(found.st_size);
    if (size < head_size || size > object_max) return {};
    const auto bytes = llvm::MemoryBuffer::getOpenFile(file, "", size, false, true); // not mapped: it may be cut short
    if (!bytes) return {};
    const std::string_view whole = (*bytes)->getBuffer(), object = whole.substr(head_size);
    if (whole.substr(0, head_size) != head_of(key, object)) return {};
    return std::string(object);
}

} // namespace

ObjectCache::ObjectCache(std::filesystem::path folder, uint64_t limit_bytes)
    : files(std::move(folder), std::string(ending), limit_bytes)
{
}

ObjectCache& ObjectCache::shared()
{
    // Code is compiled as long as the process lives.
    static auto* cache = new ObjectCache(input::KeptFiles::folder_of_environment());
    return *cache;
}

std::optional<std::string> ObjectCache::load(const ContentHash& key) const
{
    const int file = files.open(to_text(key));
    if (file < 0) return std::nullopt;
    std::optional<std::string> object = object_in(file, key);
    close(file);
    return object;
}

void ObjectCache::store(const ContentHash& key, std::string_view object)
{
    if (object.size() + head_size > object_max) return;
    const std::string head = head_of(key, object);
    const std::string_view pieces[] = {head, object};
    files.store(to_text(key), pieces);
}

} // namespace haptel::jit
