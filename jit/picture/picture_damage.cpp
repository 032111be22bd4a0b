#include "jit/picture/picture_damage.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace haptel::jit {
namespace {

constexpr const char* fine = "";

// As the reader has it: 0 beyond the end.
size_t byte(std::string_view bytes, size_t at)
{
    return at < bytes.size() ? static_cast<uint8_t>(bytes[at]) : 0;
}

size_t word(std::string_view bytes, size_t at)
{
    return byte(bytes, at) << 8 | byte(bytes, at + 1);
}

// Than what is there. The sides have 30 bits each at most.
bool is_longer(size_t width, size_t height, size_t texel_bytes, size_t there_bytes)
{
    return width > 0 && texel_bytes > 0 && height > there_bytes / texel_bytes / width;
}

// JPEG (ITU T.81, B.2.4.2): a Huffman table says how many codes there are of each of 16 lengths, 256 at most.
bool huffman_tables_fit(std::string_view bytes, size_t from, size_t to)
{
    while (from < to && from < bytes.size()) {
        size_t codes = 0;
        for (size_t length = 1; length <= 16; ++length) codes += byte(bytes, from + length);
        if (codes > 256) return false;
        from += 17 + codes;
    }
    return true;
}

const char* jpeg_damage(std::string_view bytes)
{
    for (size_t at = 0; at + 1 < bytes.size();) {
        const size_t marker = byte(bytes, at + 1);
        if (byte(bytes, at) != 0xff || marker == 0 || marker == 0xff) { // coded data, filling
            ++at;
            continue;
        }
        at += 2;
        const bool is_alone = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
        if (is_alone) continue;
        if (marker == 0xd9) return fine; // the end
        const size_t length = word(bytes, at);
        if (marker == 0xc4 && !huffman_tables_fit(bytes, at + 2, at + length))
            return "a Huffman table has too many codes";
        at += std::max<size_t>(length, 2);
    }
    return fine;
}

constexpr const char* cut_off = "it ends before its last texel";

// TGA has no mark. Whole texels as they are: 18 bytes, a name, and the texels.
const char* tga_damage(std::string_view bytes)
{
    const size_t palette = byte(bytes, 1), kind = byte(bytes, 2), bits = byte(bytes, 16);
    if (palette != 0 || (kind != 2 && kind != 3) || bits % 8 != 0) return fine;
    const size_t width = byte(bytes, 12) | byte(bytes, 13) << 8, height = byte(bytes, 14) | byte(bytes, 15) << 8;
    const size_t begin = 18 + byte(bytes, 0);
    return is_longer(width, height, bits / 8, bytes.size() - std::min(bytes.size(), begin)) ? cut_off : fine;
}

} // namespace

const char* picture_damage(std::string_view bytes)
{
    if (bytes.starts_with("\xff\xd8") || bytes.starts_with("\xff\xff")) return jpeg_damage(bytes);
    return tga_damage(bytes);
}

} // namespace haptel::jit
