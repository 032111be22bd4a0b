// The one way in which this project opens a file that somebody else wrote. A name may stand for a pipe that never ends,
// for a device that gives zeros for ever, or for more bytes than there is memory: only a regular file is read, only up
// to a size, and what is refused is told apart and put in words. Nothing waits: not for who writes to a pipe, nor for a
// terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace haptel::input {

enum class Refusal : uint8_t { none, missing, folder, not_regular, too_large, unreadable };

// Why there are no bytes. `why` goes on behind the file's name or "it": "is a pipe, not a regular file", "has 3.9 GiB,
// and at most 16 MiB are read".
struct Refused {
    Refusal refusal = Refusal::none;
    std::string why;
};

// An open file of at most `bytes_max`: for who reads it piece by piece. read_regular_file() is for who wants it whole.
class RegularFile {
public:
    RegularFile(const std::filesystem::path& file, uintmax_t bytes_max);
    ~RegularFile();
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;

    // None: it can be read, and what was read is whole. Grows past the limit: too large from then on.
    const Refused& refused() const { return refused_; }
    uintmax_t size_bytes() const { return size_bytes_; } // when it was opened; some of the system's own files say 0
    // Returns how many bytes came; 0: the end, or refused() tells why not.
    std::size_t read(char* to, std::size_t count);

private:
    Refused refused_;
    uintmax_t bytes_max_, size_bytes_ = 0, read_ = 0;
    int descriptor_ = -1;
};

struct FileBytes {
    std::string bytes;
    Refused refused;
};

// The whole file. Its size is asked for before memory is taken. Never throws but for want of memory.
FileBytes read_regular_file(const std::filesystem::path& file, uintmax_t bytes_max);

// Whether it would be read, as far as that can be told without opening it.
Refused look_at_regular_file(const std::filesystem::path& file, uintmax_t bytes_max);

// 3.9 GiB, 16 MiB, 700 bytes
std::string size_in_words(uintmax_t bytes);

} // namespace haptel::input
