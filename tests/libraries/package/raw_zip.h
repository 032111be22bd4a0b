// ZIP archives byte by byte, as its specification (APPNOTE.TXT of PKWARE) writes them, right or wrong in any field: an
// independent source of archives, which knows nothing of how the product reads and writes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haptel::test {

struct RawEntry {
    std::string name, data;
    std::optional<std::string> local_name = {}; // in the header before the data
    uint16_t method = 0, flags = 0;
    uint8_t system = 3; // Unix
    uint32_t attributes = 0100644u << 16;
    std::optional<uint32_t> crc = {}, size = {}, packed_size = {}, local_size = {}, offset = {};
    std::string extra = {};
};

struct RawZip {
    std::vector<RawEntry> entries;
    std::string before = {}, comment = {}, behind = {};
    std::optional<uint16_t> count = {};
    std::optional<uint32_t> directory_size = {}, directory_offset = {};

    std::string bytes() const;
};

uint32_t crc32_of(const std::string& bytes);

} // namespace haptel::test
