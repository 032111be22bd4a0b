#include "input/checksum.h"

#include <cstdio>
#include <cstring>

namespace haptel::input {

namespace {

__extension__ using Wide = unsigned __int128;

// Both halves of a product, folded: each bit of either factor reaches every bit (as in wyhash, by Wang Yi).
uint64_t folded(uint64_t a, uint64_t b)
{
    const Wide product = Wide{a} * b;
    return static_cast<uint64_t>(product) ^ static_cast<uint64_t>(product >> 64);
}

} // namespace

Checksum checksum(std::string_view bytes, const Checksum& before) noexcept
{
    constexpr uint64_t odd[4] = {0x9e3779b97f4a7c15, 0xbf58476d1ce4e5b9, 0x94d049bb133111eb, 0xd6e8feb86659fd93};
    uint64_t sum[4] = {before.low ^ odd[0], before.high ^ odd[1], before.low ^ odd[2], before.high ^ odd[3]};
    const auto take = [&](const char* from) {
        uint64_t word[8];
        std::memcpy(word, from, sizeof word);
        for (int k = 0; k < 4; ++k) sum[k] = folded(sum[k] ^ word[2 * k], odd[k] ^ word[2 * k + 1]) + (sum[k] << 1 | 1);
    };
    std::size_t at = 0;
    for (; at + 64 <= bytes.size(); at += 64) take(bytes.data() + at);
    char rest[64] = {};
    std::memcpy(rest, bytes.data() + at, bytes.size() - at);
    take(rest);
    const uint64_t size = bytes.size();
    const uint64_t low = folded(sum[0] ^ size, sum[1] ^ odd[2]), high = folded(sum[2] ^ size, sum[3] ^ odd[0]);
    return {folded(low ^ odd[1], high ^ odd[3]), folded(high ^ odd[0], low ^ odd[2])};
}

std::string to_text(const Checksum& sum)
{
    char text[40];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(sum.high),
                  static_cast<unsigned long long>(sum.low));
    return text;
}

} // namespace haptel::input
