// Files that one process keeps for the next: what takes long to make and can be made again.
//
// Any number of processes and threads may share a folder: a file comes into being whole, by rename, and whoever reads
// sees the old one, the new one or none. What lies there may still be damaged or of another version: who reads checks
// it. Nothing here throws, prints or fails: without a folder that can be used nothing is kept, and that costs time
// alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace haptel::input {

class KeptFiles {
public:
    // Made where it is missing, for its owner alone; an empty path: nothing is kept. Not used if somebody else may
    // write there. Names of files end so.
    KeptFiles(std::filesystem::path folder, std::string ending, uint64_t limit_bytes);

    // HAPTEL_CACHE names the folder ("off": none), else $XDG_CACHE_HOME/haptel, else ~/.cache/haptel.
    static std::filesystem::path folder_of_environment();

    // Marked as used now, for the caller to close; -1 where there is none, or none of ours.
    int open(const std::string& name) const;
    // Now and then removes what was used least lately, down to three quarters of the limit, where the limit is passed.
    void store(const std::string& name, std::span<const std::string_view> pieces);

    struct Status {
        std::string folder; // empty: switched off
        std::string fault;  // why it is not used; empty: it is
        uint64_t files = 0, bytes = 0, limit_bytes = 0;
    };
    Status status() const;
    uint64_t clear(); // how many are gone

private:
    const std::filesystem::path folder_;
    const std::string ending_;
    const uint64_t limit_bytes_;
    std::atomic<uint32_t> stored_{0};

    std::string fault() const;
    void trim() const;
};

} // namespace haptel::input
