// What a library may consist of: regular files of few kinds with plain names, and the sums that they are known by.
//
// The one place for these rules: who packs, who unpacks and who installs asks here.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace haptel::libraries {

inline constexpr std::size_t files_max = 4096, file_bytes_max = 16u << 20, library_bytes_max = 64u << 20;
inline constexpr std::size_t sums_bytes_max = 1u << 20;

// The file of sums, as sha256sum reads and writes it: `sha256sum -c SHA256SUMS` in an installed library checks it.
inline constexpr const char* sums_name = "SHA256SUMS";

using Contents = std::map<std::string, std::string>; // bytes by path, "previews/oak/board.png"

// Why no file of a library may have this path; empty: one may. Its parts are of small letters, digits, _ and -, so that
// it means the same on every file system and leads nowhere else; README.md, LICENSE and the like are let through.
std::string fault_of_path(std::string_view path);

// Why these files, without their sums, are none of a library: a path, a size, or too many of them; empty: they may be.
std::string fault_of_sizes(const Contents& contents);

// Sums of all files but the file of sums.
std::string sums_of(const Contents& contents);

// Why the files are not those that their file of sums tells of; empty: they are.
std::string fault_of_sums(const Contents& contents);

} // namespace haptel::libraries
