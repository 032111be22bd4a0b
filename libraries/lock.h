// haptel.lock: which versions of its libraries a project uses, to the byte. `haptel install --project` writes it.
#pragma once

#include "input/toml/file_messages.h"
#include "libraries/version.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::libraries {

inline constexpr const char* lock_name = "haptel.lock";
inline constexpr std::size_t lock_bytes_max = 1u << 20;

struct Locked {
    std::string name;
    Version version;
    std::string sha256; // of the library's SHA256SUMS, and so of each of its files
};

// Nothing where `messages` has got an error.
std::optional<std::vector<Locked>> read_lock(std::string_view text, input::FileMessages& messages);

// The same of a file: none is as one of no libraries. `fault`: why it cannot be read, a line.
struct LockFile {
    std::vector<Locked> libraries;
    std::string fault;
};
LockFile read_lock_file(const std::filesystem::path& file);

// By name and version, whatever the order.
std::string lock_text(std::vector<Locked> libraries);

} // namespace haptel::libraries
