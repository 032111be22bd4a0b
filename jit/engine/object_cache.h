// Machine code on disk, known by what it was made from: what one process has compiled, the next one reads.
//
// Any number of processes and threads may share a folder: an object comes into being whole, by rename, and whoever
// reads sees the old one, the new one or none. A file that is damaged, cut short, not ours or not a file is as good as
// absent and is replaced. Nothing here throws, prints or fails: without a folder that can be used there is no cache,
// and that costs time alone. A key must cover all that decides the object.
#pragma once

#include "jit/codegen/content_hash.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace haptel::jit {

class ObjectCache {
public:
    static constexpr uint64_t default_limit_bytes = uint64_t{256} << 20;

    // Made where it is missing, for its owner alone; an empty path: no cache. Not used if somebody else may write
    // there.
    explicit ObjectCache(std::filesystem::path folder, uint64_t limit_bytes = default_limit_bytes);

    // The one of this process: HAPTEL_CACHE names the folder ("off": none), else $XDG_CACHE_HOME/haptel, else
    // ~/.cache/haptel.
    static ObjectCache& shared();

    std::optional<std::string> load(const ContentHash& key) const;
    // Now and then removes what was used least lately, down to three quarters of the limit, where the limit is passed.
    void store(const ContentHash& key, std::string_view object);

    struct Status {
        std::string folder; // empty: switched off
        std::string fault;  // why it is not used; empty: it is
        uint64_t objects = 0, bytes = 0, limit_bytes = 0;
    };
    Status status() const;
    uint64_t clear(); // how many are gone

private:
    const std::filesystem::path folder;
    const uint64_t limit_bytes;
    std::atomic<uint32_t> stored{0};

    std::filesystem::path place_of(const ContentHash& key) const;
    std::string fault() const;
    void trim() const;
};

} // namespace haptel::jit
