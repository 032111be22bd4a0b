// A library as one file, X.haptlib: a ZIP archive that nothing is compressed in, so that its bytes are the same whoever
// packs it, and so that no few bytes can stand for many.
//
// Archives come from anywhere. What is read is held in memory and checked whole, before anything is written: plain
// paths, regular files, no name twice, sizes, sums. Whatever the bytes: an answer, soon, in memory of a few times their
// size.
#pragma once

#include "libraries/package/package.h"

#include <string>
#include <string_view>

namespace haptel::libraries {

// Headers of a file take some 300 bytes beside what it holds.
inline constexpr std::size_t archive_bytes_max = library_bytes_max + sums_bytes_max + files_max * 1024;

struct ArchiveResult {
    std::string bytes;
    std::string error; // empty: there are bytes
};
// The same bytes for the same files.
ArchiveResult write_archive(const Package& package);

// `name`: of the archive, in messages.
PackageResult read_archive(std::string_view bytes, const std::string& name);
PackageResult read_archive_file(const std::filesystem::path& file);

} // namespace haptel::libraries
