#include "tests/libraries/package/raw_zip.h"

namespace haptel::test {

namespace {

void put(std::string& to, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 255);
}

// From "version needed" to the sizes: what both headers of a file have.
void put_common(std::string& to, const RawEntry& entry, uint32_t size)
{
    put(to, 20, 2);
    put(to, entry.flags, 2);
    put(to, entry.method, 2);
    put(to, 0, 2);
    put(to, 33, 2); // 1980-01-01
    put(to, entry.crc.value_or(crc32_of(entry.data)), 4);
    put(to, entry.packed_size.value_or(static_cast<uint32_t>(entry.data.size())), 4);
    put(to, size, 4);
}

} // namespace

uint32_t crc32_of(const std::string& bytes)
{
    uint32_t crc = ~0u;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
}

std::string RawZip::bytes() const
{
    std::string all = before, directory;
    for (const RawEntry& entry : entries) {
        const auto offset = entry.offset.value_or(static_cast<uint32_t>(all.size()));
        const uint32_t size = entry.size.value_or(static_cast<uint32_t>(entry.data.size()));
        const std::string& local_name = entry.local_name ? *entry.local_name : entry.name;
        if (!entry.offset) {
            all += "PK\3\4";
            put_common(all, entry, entry.local_size.value_or(size));
            put(all, local_name.size(), 2);
            put(all, entry.extra.size(), 2);
            all += local_name + entry.extra + entry.data;
        }
        directory += "PK\1\2";
        put(directory, 63 | entry.system << 8, 2);
        put_common(directory, entry, size);
        put(directory, entry.name.size(), 2);
        put(directory, entry.extra.size(), 2);
        put(directory, 0, 6); // comment, disk, internal attributes
        put(directory, entry.attributes, 4);
        put(directory, offset, 4);
        directory += entry.name + entry.extra;
    }
    const auto directory_at = static_cast<uint32_t>(all.size());
    const auto number = count.value_or(static_cast<uint16_t>(entries.size()));
    all += directory + "PK\5\6";
    put(all, 0, 4);
    put(all, number, 2);
    put(all, number, 2);
    put(all, directory_size.value_or(static_cast<uint32_t>(directory.size())), 4);
    put(all, directory_offset.value_or(directory_at), 4);
    put(all, comment.size(), 2);
    return all + comment + behind;
}

} // namespace haptel::test
