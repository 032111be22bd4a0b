// What a test needs to know of a PNG file: that it is one, and its size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <utility>

namespace haptel::test {

// Width and height from the header chunk; 0, 0 if the file is no PNG.
inline std::pair<uint32_t, uint32_t> png_size(const std::filesystem::path& file)
{
    unsigned char head[24] = {};
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(head), sizeof head);
    constexpr unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (int i = 0; i < 8; ++i)
        if (!in || head[i] != signature[i]) return {0, 0};
    const auto number = [&](int at) {
        return uint32_t{head[at]} << 24 | uint32_t{head[at + 1]} << 16 | uint32_t{head[at + 2]} << 8 | head[at + 3];
    };
    return {number(16), number(20)};
}

} // namespace haptel::test
