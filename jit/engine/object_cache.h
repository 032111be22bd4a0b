// Machine code on disk, known by what it was made from: what one process has compiled, the next one reads. A file that
// is damaged, cut short, not ours or not a file is as good as absent and is replaced. A key must cover all that decides
// the object.
#pragma once

#include "input/kept_files.h"
#include "jit/codegen/content_hash.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace haptel::jit {

class ObjectCache {
public:
    static constexpr uint64_t default_limit_bytes = uint64_t{256} << 20;

    explicit ObjectCache(std::filesystem::path folder, uint64_t limit_bytes = default_limit_bytes);

    // The one of this process, in KeptFiles::folder_of_environment().
    static ObjectCache& shared();

    std::optional<std::string> load(const ContentHash& key) const;
    void store(const ContentHash& key, std::string_view object);
    input::KeptFiles::Status status() const { return files.status(); }
    uint64_t clear() { return files.clear(); } // how many are gone

private:
    input::KeptFiles files;
};

} // namespace haptel::jit
