// Every kind of picture, to the last bit of its numbers; and pictures that are none.
#include "jit/picture/image_file.h"
#include "jit/picture/picture.h"
#include "tests/jit/picture/pictures.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

using namespace haptel;
using namespace haptel::test;

namespace {

constexpr int columns = 37, rows = 21;

double smooth(int column, int row)
{
    return 0.5 + 0.3 * std::sin(0.4 * column) + 0.15 * std::cos(0.5 * row + 0.1 * column);
}

jit::Picture decoded(const std::string& bytes, jit::Colours colours = jit::Colours::ignored)
{
    return jit::read_picture(bytes, colours);
}

// The largest difference to `value` over all texels.
double furthest_from(const jit::Picture& picture, const Texels& value)
{
    INFO(picture.error);
    REQUIRE(picture.error.empty());
    REQUIRE((picture.width == columns && picture.height == rows));
    REQUIRE(picture.gray.size() == size_t{columns} * rows);
    double furthest = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            furthest = std::max(
                furthest, std::fabs(picture.gray[static_cast<size_t>(row * columns + column)] - value(column, row)));
    return furthest;
}

// Of whole numbers of so many bits.
Texels rounded(int bits, const Texels& value)
{
    const double unit = static_cast<double>((uint64_t{1} << bits) - 1);
    return [=](int column, int row) { return std::round(value(column, row) * unit) / unit; };
}

void append(void* to, void* data, int size)
{
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

std::string jpeg(int quality)
{
    std::vector<uint8_t> texels;
    for (int row = rows - 1; row >= 0; --row)
        for (int column = 0; column < columns; ++column)
            texels.push_back(static_cast<uint8_t>(std::lround(255 * smooth(column, row))));
    std::string bytes;
    stbi_write_jpg_to_func(append, &bytes, columns, rows, 1, texels.data(), quality);
    return bytes;
}

struct Sample {
    const char* name;
    std::string bytes;
};

// One of each.
std::vector<Sample> samples()
{
    TiffKind tiled{32, Numbers::real}, colour{8, Numbers::unsigned_whole};
    tiled.tile = 16;
    colour.colour = true;
    return {{"png of 8 bits", png(columns, rows, 8, smooth)},
            {"png of 16 bits", png(columns, rows, 16, smooth)},
            {"jpeg", jpeg(90)},
            {"tiff of 16 bits", tiff(columns, rows, {16, Numbers::unsigned_whole}, smooth)},
            {"tiff, tiled, real", tiff(columns, rows, tiled, smooth)},
            {"tiff of colours", tiff(columns, rows, colour, smooth)},
            {"exr", exr(columns, rows, false, {{"Y"}}, smooth)},
            {"exr of halves", exr(columns, rows, true, {{"B", 0.25}, {"G", 0.5}, {"R", 1}}, smooth)}};
}

} // namespace

TEST_CASE("picture: PNG of 8 and 16 bits and JPEG")
{
    for (const int bits : {8, 16})
        CHECK(furthest_from(decoded(png(columns, rows, bits, smooth)), rounded(bits, smooth)) < 1e-15);
    CHECK(furthest_from(decoded(jpeg(100)), smooth) < 0.02);
}

TEST_CASE("picture: TIFF of 8, 16 and 32 bits, whole and real, in strips and tiles, of both byte orders")
{
    for (const bool little : {true, false})
        for (const int tile : {0, 16, 64})
            for (const Numbers numbers : {Numbers::unsigned_whole, Numbers::signed_whole, Numbers::real})
                for (const int bits : {8, 16, 32, 64}) {
                    const bool is_real = numbers == Numbers::real;
                    if (is_real ? bits < 16 : bits > 32) continue;
                    CAPTURE(little, tile, bits, int(numbers));
                    TiffKind kind{bits, numbers};
                    kind.little = little;
                    kind.tile = tile;
                    const bool is_signed = numbers == Numbers::signed_whole;
                    const Texels value = [=](int column, int row) { // also below 0, and beyond 1 where that may be
                        const double real = 7 * smooth(column, row) - 3;
                        return is_real     ? bits > 16 ? real : std::round(256 * real) / 256 // a half has 10 bits
                               : is_signed ? 2 * smooth(column, row) - 1
                                           : smooth(column, row);
                    };
                    const Texels expected =
                        is_real
                            ? bits == 64
                                  ? value
                                  : [=](int column,
                                        int row) { return static_cast<double>(static_cast<float>(value(column, row))); }
                            : rounded(bits - is_signed, value);
                    CHECK(furthest_from(decoded(tiff(columns, rows, kind, value)), expected) < 1e-15);
                }
}

TEST_CASE("picture: colours count by their brightness, white may be zero, planes may lie apart")
{
    const double tinted = 0.299 * tiff_tint[0] + 0.587 * tiff_tint[1] + 0.114 * tiff_tint[2];
    const Texels colour = [=](int column, int row) { return tinted * smooth(column, row); };
    for (const bool apart : {false, true})
        for (const int tile : {0, 32}) {
            TiffKind kind{16, Numbers::unsigned_whole};
            kind.colour = true;
            kind.planes_apart = apart;
            kind.tile = tile;
            CHECK(furthest_from(decoded(tiff(columns, rows, kind, smooth)), colour) < 2.0 / 65535);
        }
    TiffKind negative{8, Numbers::unsigned_whole};
    negative.white_is_zero = true;
    CHECK(furthest_from(decoded(tiff(columns, rows, negative, smooth)), rounded(8, smooth)) < 1e-15);
    CHECK(furthest_from(decoded(exr(columns, rows, false, {{"B", 0.25}, {"G", 0.5}, {"R", 1}}, smooth)), colour) <
          1e-6);
}

TEST_CASE("picture: levels are those of the file's numbers, real ones have none, and a JPEG has blocks")
{
    const auto levels = [](const std::string& bytes) { return decoded(bytes).levels; };
    CHECK(levels(png(columns, rows, 8, smooth)) == 255);
    CHECK(levels(png(columns, rows, 16, smooth)) == 65535);
    CHECK(levels(jpeg(90)) == 255);
    CHECK(levels("P5\n1 1\n63\n" + std::string(1, '\x07')) == 63);
    CHECK(levels(tiff(columns, rows, {8, Numbers::unsigned_whole}, smooth)) == 255);
    CHECK(levels(tiff(columns, rows, {8, Numbers::signed_whole}, smooth)) == 127);
    CHECK(levels(tiff(columns, rows, {16, Numbers::unsigned_whole}, smooth)) == 65535);
    CHECK(levels(tiff(columns, rows, {32, Numbers::real}, smooth)) == 0);
    CHECK(levels(exr(columns, rows, true, {{"Y"}}, smooth)) == 0);
    CHECK(decoded(jpeg(90)).has_blocks);
    CHECK(!decoded(png(columns, rows, 8, smooth)).has_blocks);
    CHECK(!decoded(tiff(columns, rows, {8, Numbers::unsigned_whole}, smooth)).has_blocks);
    const std::vector<jit::GrainNote> notes = jit::grain_notes(jit::grain_of(decoded(jpeg(90))), "a.jpg", 0);
    REQUIRE(notes.size() == 1); // too shallow for its levels, not for its blocks
    CHECK(notes[0].message.find("'a.jpg' is coded in blocks of 8 x 8 texels") == 0);
}

TEST_CASE("picture: EXR of 16 and 32 bits, values as they are")
{
    const Texels value = [](int column, int row) { return 40 * smooth(column, row) - 20; };
    const Texels as_float = [&](int column, int row) {
        return static_cast<double>(static_cast<float>(value(column, row)));
    };
    CHECK(furthest_from(decoded(exr(columns, rows, false, {{"Y"}}, value)), as_float) == 0);
    CHECK(furthest_from(decoded(exr(columns, rows, false, {{"height"}}, value)), as_float) == 0);
    CHECK(furthest_from(decoded(exr(columns, rows, true, {{"A"}, {"Y"}}, value)), value) < 20 * 0x1p-10);
    CHECK(decoded(exr(columns, rows, false, {{"U"}, {"V"}}, value)).error.find("no channel") != std::string::npos);
}

TEST_CASE("picture: numbers that are none are told, with their place")
{
    const Folder folder;
    folder.write("hole.exr", exr(5, 4, false, {{"Y"}}, [](int column, int row) {
                     return column == 3 && row == 1 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
                 }));
    const jit::ImageFile read = jit::read_image(folder.file("hole.exr"), {}, {});
    CHECK_FALSE(read.image);
    CHECK(read.error.find("'") == 0);
    CHECK(read.error.find("texel (3, 1) is not a number") != std::string::npos);
}

TEST_CASE("picture: a file that is cut off anywhere is an error in words, or what is left of it")
{
    for (const Sample& sample : samples()) {
        CAPTURE(sample.name);
        REQUIRE(decoded(sample.bytes).error.empty());
        size_t refused = 0, cuts = 0;
        for (size_t size = 0; size < sample.bytes.size(); size += size < 400 ? 1 : 53) {
            const jit::Picture picture = decoded(sample.bytes.substr(0, size));
            CHECK(picture.error.empty() == !picture.gray.empty());
            refused += !picture.error.empty();
            ++cuts;
        }
        CHECK(2 * refused > cuts); // a JPEG's rows that are missing are gray
    }
}

TEST_CASE("picture: a PNG that ends in its texels is told in words for people")
{
    const std::string whole = png(columns, rows, 16, smooth);
    CHECK(decoded(whole.substr(0, whole.size() / 2)).error == "is damaged: Corrupt PNG");
}

TEST_CASE("picture: a PNM or TGA that ends before its last texel is refused, a whole one is read")
{
    const auto tga = [](int bits, int kind) {
        FileBytes file;
        for (const int byte : {2, 0, kind, 0, 0, 0, 0, 0}) file.put(static_cast<uint8_t>(byte)); // a name of 2 bytes
        for (const int word : {0, 0, 5, 3}) file.put(static_cast<uint16_t>(word));
        for (const int byte : {bits, 0, 104, 105}) file.put(static_cast<uint8_t>(byte));
        return file.bytes;
    };
    const std::pair<std::string, size_t> heads[] = {{"P5 5 3 255\n", 1}, {"P5\n# heights\n5 3\n65535\n", 2},
                                                    {"P6 5 3 255\n", 3}, {"P6 5 3 1000\n", 6},
                                                    {tga(8, 3), 1},      {tga(24, 2), 3},
                                                    {tga(32, 2), 4}};
    for (const auto& [head, texel_bytes] : heads) {
        CAPTURE(head, texel_bytes);
        const size_t all = 15 * texel_bytes;
        const jit::Picture whole = decoded(head + std::string(all, '\xff'));
        CHECK(whole.error.empty());
        CHECK(whole.gray.size() == 15);
        for (const size_t there : {size_t{0}, size_t{1}, all / 2, all - 1})
            CHECK(decoded(head + std::string(there, '\xff')).error == "is damaged: it ends before its last texel");
    }

    const std::string packet = "\x8e\x60"; // 15 times the same texel of 8 bits
    CHECK(decoded(tga(8, 11) + packet).gray.size() == 15);
    for (const int kind : {10, 11})
        CHECK(decoded(tga(8, kind) + "\x8e").error == "is damaged: it ends before its last texel");
}

TEST_CASE("picture: a BMP that ends before its last texel is refused, a whole one is read")
{
    for (const int head : {12, 40})
        for (const int32_t rows : {3, -3}) {
            if (head == 12 && rows < 0) continue;
            CAPTURE(head, rows);
            FileBytes file;
            for (const char mark : {'B', 'M'}) file.put(static_cast<uint8_t>(mark));
            for (const int number : {0, 0, 14 + head, head}) file.put(static_cast<uint32_t>(number));
            if (head == 12)
                for (const int number : {5, 3, 1, 24}) file.put(static_cast<uint16_t>(number));
            else {
                for (const int number : {5, rows}) file.put(static_cast<uint32_t>(number));
                for (const int number : {1, 24}) file.put(static_cast<uint16_t>(number));
                for (int i = 0; i < 6; ++i) file.put(uint32_t{0});
            }
            const size_t all = 3 * 16; // rows of whole words
            CHECK(decoded(file.bytes + std::string(all, '\x60')).gray.size() == 15);
            for (const size_t there : {size_t{0}, size_t{1}, all / 2, all - 1})
                CHECK(decoded(file.bytes + std::string(there, '\x60')).error ==
                      "is damaged: it ends before its last texel");
        }
}

// The format's own words (netpbm.sourceforge.net/doc/pgm.html): two bytes with the most significant first where the
// greatest value is above 255, and grays as shares of it.
TEST_CASE("picture: what a PNM says is a share of its greatest value, in one byte or two, gray or in colour")
{
    const std::string in_one = "P5 2 1 200\n\x64\xc8", in_two = std::string("P5 2 1 1000\n\x01\xf4\x03\xe8", 16);
    for (const std::string& bytes : {in_one, in_two}) {
        const jit::Picture picture = decoded(bytes);
        REQUIRE(picture.error.empty());
        CHECK(picture.gray == std::vector<double>{0.5, 1});
    }
    const std::string colours("P6 1 2 65535\n\xff\xff\x00\x00\x00\x00\x00\x00\xff\xff\x80\x00", 25);
    const jit::Picture coloured = decoded(colours); // red above; green and half of blue below
    REQUIRE(coloured.error.empty());
    CHECK(std::fabs(coloured.gray[1] - 0.299) < 1e-12);
    CHECK(std::fabs(coloured.gray[0] - (0.587 + 0.114 * 32768 / 65535)) < 1e-12);
    CHECK(decoded("P5 1 1 200\n\xff").gray == std::vector<double>{1}); // beyond the greatest
    for (const char* most : {"0", "65536"})
        CHECK(decoded(std::string("P5 1 1 ") + most + "\nab").error ==
              "is damaged: its greatest value is not one from 1 to 65535");
}

TEST_CASE("picture: damaged files end in a picture or in words, and never in more memory than a picture may have")
{
    std::mt19937_64 random(1);
    for (const Sample& sample : samples()) {
        CAPTURE(sample.name);
        size_t refused = 0;
        for (int i = 0; i < 1500; ++i) {
            std::string bytes = sample.bytes;
            // Where the directory or the header stands more often than among the texels.
            const size_t where = sample.name[0] == 't' && i % 2
                                     ? bytes.size() - 1 - random() % std::min<size_t>(400, bytes.size())
                                 : i % 3 ? random() % std::min<size_t>(400, bytes.size())
                                         : random() % bytes.size();
            for (size_t k = 0, count = 1 + random() % 4; k < count; ++k)
                bytes[std::min(bytes.size() - 1, where + random() % 4)] = static_cast<char>(random());
            const jit::Picture picture = decoded(bytes);
            CHECK(picture.error.empty() == !picture.gray.empty());
            CHECK(picture.gray.size() == static_cast<size_t>(picture.width * picture.height));
            refused += !picture.error.empty();
        }
        CHECK(refused > 10);
    }
}

TEST_CASE("picture: tables and numbers that some readers take without a look are refused")
{
    std::string bytes = jpeg(90);
    CHECK(decoded(bytes).error.empty());
    const size_t table = bytes.find("\xff\xc4");
    REQUIRE(table != bytes.npos);
    bytes[table + 5 + 15] = '\xff'; // of 16 bits: 255 codes, beside those of other lengths
    CHECK(decoded(bytes).error == "is damaged: a Huffman table has too many codes");

    CHECK(decoded("P5\n# 12345678901 of them\n2 1\n255\nab").error.empty());
    CHECK(decoded("P5 4294967298 1 255\nab").error == "is damaged: a number in its header is too large");
}

TEST_CASE("picture: what claims to be huge is refused before memory is taken")
{
    for (const Sample& sample : {Sample{"tiff", tiff(2, 2, {8, Numbers::unsigned_whole}, smooth)},
                                 Sample{"exr", exr(2, 2, false, {{"Y"}}, smooth)}}) {
        CAPTURE(sample.name);
        std::string bytes = sample.bytes;
        if (sample.name[0] == 't') { // its directory's first two entries: width and height
            uint32_t at;
            std::memcpy(&at, bytes.data() + 4, 4);
            for (const uint32_t entry : {0u, 1u}) bytes.replace(at + 2 + 12 * entry + 8, 4, "\xff\xff\xff\x7f");
        } else {
            for (size_t from = 0; (from = bytes.find("box2i", from)) != std::string::npos; ++from)
                bytes.replace(from + 6 + 4 + 8, 8, "\xff\xff\xff\x7f\xff\xff\xff\x7f");
        }
        const jit::Picture picture = decoded(bytes);
        CHECK_FALSE(picture.error.empty());
        CHECK(picture.gray.empty());
    }
}

TEST_CASE("image: a picture that unpacks to far more than its texels is refused, and takes no memory for that")
{
    std::string zeros(8 << 20, '\0');
    int size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> packed(
        stbi_zlib_compress(reinterpret_cast<unsigned char*>(zeros.data()), static_cast<int>(zeros.size()), &size, 8),
        std::free);
    REQUIRE(packed);
    const std::string bytes(reinterpret_cast<const char*>(packed.get()), static_cast<std::size_t>(size));
    CHECK(decoded(packed_png(1, 1, 8, bytes)).error == "is damaged: it unpacks to more than 1 x 1 texels");
    CHECK(decoded(packed_png(2048, 2048, 8, bytes)).error.empty()); // 4 MiB of them are its own
}

TEST_CASE("image: more texels than can be felt are refused by the picture's own size, before they are unpacked")
{
    const jit::Picture picture = decoded(packed_png(8192, 8192, 8, "none"));
    CHECK(picture.error == "is too large: 8192 x 8192 texels");
    CHECK(picture.hint.find("16777216") != std::string::npos);
}

// The specifications of PNG and TGA, as another writer has them; of TIFF and EXR, as pictures.h has them.
TEST_CASE("picture: red, green, blue and alpha, where the file has them and they are asked for")
{
    using Colours = jit::Colours;
    const auto value = [](int column, int row, int channel) {
        return (7 * column + 5 * row + 60 * channel) % 256 / 255.0;
    };
    for (const int channels : {1, 2, 3, 4}) {
        std::vector<uint8_t> texels;
        for (int row = rows - 1; row >= 0; --row)
            for (int column = 0; column < columns; ++column)
                for (int i = 0; i < channels; ++i)
                    texels.push_back(static_cast<uint8_t>(std::lround(255 * value(column, row, i))));
        std::string png, tga;
        stbi_write_png_to_func(append, &png, columns, rows, channels, texels.data(), columns * channels);
        stbi_write_tga_to_func(append, &tga, columns, rows, channels, texels.data());
        for (const std::string& bytes : {png, tga}) {
            CAPTURE(channels, bytes == png);
            const jit::Picture picture = decoded(bytes, Colours::kept);
            for (size_t i = 0; i < 4; ++i) {
                const bool is_there = i < 3 ? channels >= 3 : channels % 2 == 0;
                REQUIRE(picture.colours[i].size() == (is_there ? picture.gray.size() : 0));
                const int channel = i < 3 ? static_cast<int>(i) : channels - 1;
                for (int row = 0; is_there && row < rows; ++row)
                    for (int column = 0; column < columns; ++column)
                        REQUIRE(std::fabs(picture.colours[i][static_cast<size_t>(row * columns + column)] -
                                          value(column, row, channel)) < 1e-15);
            }
            const Texels brightness = [&](int column, int row) {
                if (channels < 3) return value(column, row, 0);
                return 0.299 * value(column, row, 0) + 0.587 * value(column, row, 1) + 0.114 * value(column, row, 2);
            };
            CHECK(furthest_from(picture, brightness) < 1e-15);
            const jit::Picture plain = decoded(bytes);
            CHECK(plain.gray == picture.gray);
            for (const auto& colour : plain.colours) CHECK(colour.empty());
        }
    }
    const auto is_tinted = [](const std::string& bytes, std::array<double, 4> tint) {
        const jit::Picture picture = decoded(bytes, Colours::kept);
        REQUIRE(picture.error.empty());
        for (size_t i = 0; i < 4; ++i) {
            REQUIRE(picture.colours[i].size() == (tint[i] > 0 ? picture.gray.size() : 0));
            for (int row = 0; tint[i] > 0 && row < rows; ++row)
                for (int column = 0; column < columns; ++column)
                    REQUIRE(std::fabs(picture.colours[i][static_cast<size_t>(row * columns + column)] -
                                      tint[i] * smooth(column, row)) < 1e-4);
        }
    };
    for (const bool apart : {false, true}) {
        TiffKind kind{16, Numbers::unsigned_whole};
        kind.colour = true;
        kind.planes_apart = apart;
        is_tinted(tiff(columns, rows, kind, smooth), {tiff_tint[0], tiff_tint[1], tiff_tint[2], 0});
    }
    is_tinted(exr(columns, rows, false, {{"A", 0.125}, {"B", 0.25}, {"G", 0.5}, {"R", 1}}, smooth),
              {1, 0.5, 0.25, 0.125});
    is_tinted(exr(columns, rows, false, {{"A", 0.125}, {"Y"}}, smooth), {0, 0, 0, 0.125});
    const jit::Picture map = decoded("P6\n2 1\n255\n" + std::string("\x00\x33\xff\xff\x66\x00", 6), Colours::kept);
    CHECK(map.colours[0] == std::vector{0.0, 1.0});
    CHECK(map.colours[1] == std::vector{0.2, 0.4});
    CHECK(map.colours[2] == std::vector{1.0, 0.0});
    CHECK(map.colours[3].empty());
}
