#include "jit/picture/picture.h"

#include "lang/ir/bounds/spline_image.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace haptel::jit {
namespace {

// What one allocation of the reader below may take, set by who calls it: some formats do not say what their bytes
// unpack to, and a kilobyte may hold a gigabyte of zeros.
thread_local std::size_t allocation_max = 0;

void* reallocate(void* old, std::size_t bytes)
{
    return bytes <= allocation_max ? std::realloc(old, bytes) : nullptr;
}

} // namespace
} // namespace haptel::jit

#define STBI_MALLOC(bytes) haptel::jit::reallocate(nullptr, bytes)
#define STBI_REALLOC(old, bytes) haptel::jit::reallocate(old, bytes)
#define STBI_FREE(old) std::free(old)
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_FAILURE_USERMSG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace haptel::jit {

Picture no_picture(std::string error, std::string hint)
{
    return {.error = std::move(error), .hint = std::move(hint)};
}

Picture picture_of(int64_t width, int64_t height)
{
    using ir::SplineImage;
    if (width < 1 || height < 1) return no_picture("has no texels");
    if (width > SplineImage::side_max || height > SplineImage::side_max || width * height > SplineImage::texels_max)
        return no_picture("is too large: " + std::to_string(width) + " x " + std::to_string(height) + " texels",
                          "a side may have " + std::to_string(SplineImage::side_max) + ", the whole " +
                              std::to_string(SplineImage::texels_max));
    Picture made;
    made.gray.resize(static_cast<size_t>(width * height));
    made.width = width;
    made.height = height;
    return made;
}

void keep_colours(Picture& picture, size_t samples)
{
    for (size_t i = 0; i < picture.colours.size(); ++i)
        if (i < 3 ? samples >= 3 : samples % 2 == 0) picture.colours[i].resize(picture.gray.size());
}

Picture read_picture(std::string_view bytes, Colours colours)
{
    using namespace std::string_view_literals;
    const std::string_view head = bytes.substr(0, 4);
    const bool is_tiff = head == "II*\0"sv || head == "MM\0*"sv || head == "II+\0"sv || head == "MM\0+"sv;
    const bool is_pnm = head.starts_with("P5") || head.starts_with("P6");
    return is_tiff                      ? read_tiff(bytes, colours)
           : head == "\x76\x2f\x31\x01" ? read_exr(bytes, colours)
           : is_pnm                     ? read_pnm(bytes, colours)
                                        : read_common_picture(bytes, colours);
}

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

// The lowest byte first.
uint64_t number(std::string_view bytes, size_t at, size_t count)
{
    return count == 0 ? 0 : byte(bytes, at) | number(bytes, at + 1, count - 1) << 8;
}

// Rows of whole words, from a place that the file names. What is packed the reader does not know.
bool is_cut_bmp(std::string_view bytes)
{
    const bool is_first = number(bytes, 14, 4) == 12; // of 1988: sizes of 16 bits
    const uint64_t width = number(bytes, 18, is_first ? 2 : 4), bits = number(bytes, is_first ? 24 : 28, 2);
    const auto height = static_cast<int32_t>(number(bytes, is_first ? 20 : 22, is_first ? 2 : 4)); // < 0: from the top
    if (!is_first && number(bytes, 30, 4) % 3 != 0) return false;
    const uint64_t row = (width * bits + 31) / 32 * 4, begin = number(bytes, 10, 4);
    return row != 0 && (begin > bytes.size() || std::abs(int64_t{height}) > int64_t((bytes.size() - begin) / row));
}

// TGA has no mark: 18 bytes, a name, a palette, and the texels, as they are or up to 128 of them in a packet.
bool is_cut_tga(std::string_view bytes)
{
    const uint64_t palette = byte(bytes, 1), kind = byte(bytes, 2), texel = byte(bytes, 16) / 8;
    const bool is_packed = kind > 8;
    if (palette > 1 || kind % 8 == 0 || kind % 8 > 3 || kind > 11 || byte(bytes, 16) % 8 != 0) return false;
    const uint64_t texels = number(bytes, 12, 2) * number(bytes, 14, 2);
    const uint64_t begin = 18 + byte(bytes, 0) + palette * number(bytes, 5, 2) * (byte(bytes, 7) / 8);
    return begin + (is_packed ? (texels + 127) / 128 * (1 + texel) : texels * texel) > bytes.size();
}

// Damage that the reader of common pictures takes without a look in some of its releases, and computes with: of what is
// cut off it takes memory that nobody has written. In words, what is wrong; empty: nothing of that kind. Of formats
// that it does not know nothing is said.
const char* picture_damage(std::string_view bytes)
{
    if (bytes.starts_with("\xff\xd8") || bytes.starts_with("\xff\xff")) return jpeg_damage(bytes);
    return (bytes.starts_with("BM") ? is_cut_bmp(bytes) : is_cut_tga(bytes)) ? "it ends before its last texel" : fine;
}

} // namespace

Picture read_common_picture(std::string_view bytes, Colours colours)
{
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size()); // image_bytes_max fits
    constexpr const char* formats = "a picture is a PNG, JPEG, TIFF, EXR, BMP, TGA or PGM file";
    if (const std::string damage = picture_damage(bytes); !damage.empty())
        return no_picture("is damaged: " + damage, formats);
    int width = 0, height = 0, channels = 0;
    allocation_max = 1 << 20;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        return no_picture("is no picture that can be read", formats);
    Picture made = picture_of(width, std::abs(int64_t{height})); // < 0: a BMP from the top
    if (!made.error.empty()) return made;
    // Twice, as it grows by doubling: the file's own bytes, and 4 channels of 16 bits for each texel.
    allocation_max += 2 * (bytes.size() + 8 * made.gray.size() + static_cast<size_t>(made.height));
    const std::unique_ptr<stbi_us, void (*)(void*)> texels(
        stbi_load_16_from_memory(data, size, &width, &height, &channels, 0), stbi_image_free);
    if (!texels && std::string_view(stbi_failure_reason()) == "Out of memory")
        return no_picture("is damaged: it unpacks to more than " + std::to_string(width) + " x " +
                              std::to_string(height) + " texels",
                          formats);
    if (!texels) return no_picture(std::string("is damaged: ") + stbi_failure_reason(), formats);
    made.levels = stbi_is_16_bit_from_memory(data, size) ? 65535 : 255;
    made.has_blocks = bytes.starts_with("\xff\xd8\xff");
    if (width != made.width || height != made.height) return no_picture("is damaged: it has two sizes");
    if (colours == Colours::kept) keep_colours(made, static_cast<size_t>(channels));
    const stbi_us* from = texels.get();
    for (int64_t row = height; row-- > 0;) // files begin at the top
        for (int64_t column = 0; column < width; ++column, from += channels) {
            double samples[4] = {};
            for (int i = 0; i < channels; ++i) samples[i] = from[i] / 65535.0;
            put_texel(made, static_cast<size_t>(row * width + column), {samples, static_cast<size_t>(channels)});
        }
    return made;
}

} // namespace haptel::jit
