// TIFF files as other programs write them.
#include "jit/picture/picture.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <tiffio.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

using namespace haptel;
using namespace haptel::test;

// Bits and values as IEEE 754 has them.
TEST_CASE("picture: a TIFF of half floats as programs write it, packed and predicted, is read to the last bit")
{
    const Folder folder;
    const std::string file = folder.file("halves.tif");
    const std::array<std::pair<uint16_t, double>, 8> halves = {{{0x3c00, 1.0},
                                                                {0xc000, -2.0},
                                                                {0x3555, 0.333251953125},
                                                                {0x0001, 0x1p-24},
                                                                {0x03ff, 0x1p-14 - 0x1p-24},
                                                                {0x0400, 0x1p-14},
                                                                {0x7bff, 65504.0},
                                                                {0x8000, -0.0}}};
    const auto write = [&](uint16_t bits, auto row) {
        TIFF* const tiff = TIFFOpen(file.c_str(), "w");
        REQUIRE(tiff);
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, uint32_t{8});
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, uint32_t{1});
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
        if (bits == 16) TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_FLOATINGPOINT);
        CHECK(TIFFWriteScanline(tiff, row.data(), 0, 0) == 1);
        TIFFClose(tiff);
        std::ifstream in(file, std::ios::binary);
        return jit::read_tiff(std::string{std::istreambuf_iterator<char>(in), {}});
    };
    std::array<uint16_t, 8> row;
    for (size_t i = 0; i < 8; ++i) row[i] = halves[i].first;
    const jit::Picture picture = write(16, row);
    CHECK(picture.error.empty());
    REQUIRE(picture.gray.size() == 8);
    for (size_t i = 0; i < 8; ++i) CHECK(picture.gray[i] == halves[i].second);

    const jit::Picture odd = write(24, std::array<uint8_t, 24>{});
    CHECK(odd.error == "is a TIFF of a kind that is not read, of 24 bits a sample, real: Sorry, can not handle images "
                       "with 24-bit samples");
    CHECK(odd.hint == "TIFF of 8, 16 or 32 bits, gray or RGB, whole numbers or real ones");
}

TEST_CASE("picture: a TIFF whose packed samples are damaged is refused")
{
    const Folder folder;
    const std::string file = folder.file("packed.tif");
    TIFF* const tiff = TIFFOpen(file.c_str(), "w");
    REQUIRE(tiff);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, uint32_t{64});
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, uint32_t{2});
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
    std::array<uint16_t, 64> row;
    for (size_t i = 0; i < row.size(); ++i) row[i] = static_cast<uint16_t>(2749 * i);
    for (uint32_t k = 0; k < 2; ++k) CHECK(TIFFWriteScanline(tiff, row.data(), k, 0) == 1);
    TIFFClose(tiff);
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    CHECK(jit::read_tiff(bytes).error.empty());
    bytes.replace(16, 16, 16, '\xff'); // behind the header come the samples
    CHECK(jit::read_tiff(bytes).error.find("is damaged") == 0);
}

// TIFF 6.0, section 8: of whole numbers that are WhiteIsZero 0 is white and the greatest is black. A real number has no
// greatest one to be counted from, and is a height as it stands.
TEST_CASE("picture: a TIFF in which white is 0 is turned over where it has whole numbers, and only there")
{
    const Folder folder;
    const std::string file = folder.file("white.tif");
    const auto read = [&](uint16_t photometric, uint16_t format, auto... values) {
        std::array row{values...};
        TIFF* const tiff = TIFFOpen(file.c_str(), "w");
        REQUIRE(tiff);
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<uint32_t>(row.size()));
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, uint32_t{1});
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<uint16_t>(8 * sizeof row[0]));
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, format);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, photometric);
        CHECK(TIFFWriteScanline(tiff, row.data(), 0, 0) == 1);
        TIFFClose(tiff);
        std::ifstream in(file, std::ios::binary);
        jit::Picture picture = jit::read_tiff(std::string{std::istreambuf_iterator<char>(in), {}});
        CHECK(picture.error.empty());
        return picture.gray;
    };
    using Grays = std::vector<double>;
    const uint16_t whole = SAMPLEFORMAT_UINT, real = SAMPLEFORMAT_IEEEFP, white = PHOTOMETRIC_MINISWHITE;
    CHECK(read(white, whole, uint8_t{0}, uint8_t{51}, uint8_t{255}) == Grays{1, 1 - 0.2, 0});
    CHECK(read(white, whole, uint16_t{0}, uint16_t{65535}) == Grays{1, 0});
    CHECK(read(white, real, 0.25f, -3.5f, 1e6f) == Grays{0.25, -3.5, 1e6});
    CHECK(read(white, real, 0.1, 1.0) == Grays{0.1, 1});
    CHECK(read(PHOTOMETRIC_MINISBLACK, real, 0.25f, -3.5f) == Grays{0.25, -3.5});
    CHECK(read(PHOTOMETRIC_MINISBLACK, whole, uint8_t{51}, uint8_t{255}) == Grays{0.2, 1});
}

// TIFF 6.0, ExtraSamples: 0 is of no meaning, 1 and 2 are alpha.
TEST_CASE("picture: of a TIFF's extra samples the one that is alpha is, wherever it stands, and no other")
{
    const Folder folder;
    const std::string file = folder.file("extra.tif");
    for (const uint16_t planes : std::array<uint16_t, 2>{PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
        const auto read = [&](std::vector<uint16_t> extra) {
            TIFF* const tiff = TIFFOpen(file.c_str(), "w");
            REQUIRE(tiff);
            const auto samples = static_cast<uint16_t>(3 + extra.size());
            TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, uint32_t{1});
            TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, uint32_t{1});
            TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, uint16_t{8});
            TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
            TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
            TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, planes);
            TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<uint16_t>(extra.size()), extra.data());
            std::vector<uint8_t> texel;
            for (uint16_t i = 0; i < samples; ++i) texel.push_back(static_cast<uint8_t>(51 * i));
            if (planes == PLANARCONFIG_CONTIG)
                CHECK(TIFFWriteScanline(tiff, texel.data(), 0, 0) == 1);
            else
                for (uint16_t i = 0; i < samples; ++i) CHECK(TIFFWriteScanline(tiff, &texel[i], 0, i) == 1);
            TIFFClose(tiff);
            std::ifstream in(file, std::ios::binary);
            jit::Picture picture =
                jit::read_tiff(std::string{std::istreambuf_iterator<char>(in), {}}, jit::Colours::kept);
            CHECK(picture.error.empty());
            CHECK(picture.colours[2] == std::vector<double>{0.4});
            return picture.colours[3];
        };
        CAPTURE(planes);
        CHECK(read({EXTRASAMPLE_UNSPECIFIED}).empty());
        CHECK(read({EXTRASAMPLE_UNASSALPHA}) == std::vector<double>{0.6});
        CHECK(read({EXTRASAMPLE_UNSPECIFIED, EXTRASAMPLE_UNASSALPHA}) == std::vector<double>{0.8});
    }
}

namespace {

// Three columns and two rows as they stand in the file, of so many bits a sample; the numbers are in steps of 1/10.
jit::Picture six_texels(const std::string& file, uint16_t bits, uint16_t orientation, bool of_a_palette)
{
    TIFF* const tiff = TIFFOpen(file.c_str(), "w");
    REQUIRE(tiff);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, uint32_t{3});
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, uint32_t{2});
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, uint16_t{1});
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, orientation);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, of_a_palette ? PHOTOMETRIC_PALETTE : PHOTOMETRIC_MINISBLACK);
    std::array<uint16_t, 256> grays{};
    for (uint16_t i = 0; i < 256; ++i) grays[i] = static_cast<uint16_t>(257 * i);
    if (of_a_palette) TIFFSetField(tiff, TIFFTAG_COLORMAP, grays.data(), grays.data(), grays.data());
    for (uint32_t row = 0; row < 2; ++row) {
        std::array<uint8_t, 3> bytes{};
        std::array<uint16_t, 3> words{};
        for (uint32_t column = 0; column < 3; ++column) {
            const uint32_t tenths = 1 + 3 * row + column;
            bytes[column] = static_cast<uint8_t>(25.5 * tenths);
            words[column] = static_cast<uint16_t>(6553.5 * tenths);
        }
        CHECK(TIFFWriteScanline(tiff, bits == 8 ? static_cast<void*>(bytes.data()) : words.data(), row, 0) == 1);
    }
    TIFFClose(tiff);
    std::ifstream in(file, std::ios::binary);
    return jit::read_tiff(std::string{std::istreambuf_iterator<char>(in), {}});
}

} // namespace

// TIFF 6.0, section 8, "Orientation": which side of the picture the file's row 0 and column 0 are.
TEST_CASE("picture: a TIFF lies as its orientation says, whatever its bits")
{
    const Folder folder;
    struct Lying {
        uint16_t orientation;
        int64_t width, height;
        std::string rows; // of tenths, from the top
    };
    const Lying all[] = {
        {ORIENTATION_TOPLEFT, 3, 2, "123456"},  {ORIENTATION_TOPRIGHT, 3, 2, "321654"},
        {ORIENTATION_BOTRIGHT, 3, 2, "654321"}, {ORIENTATION_BOTLEFT, 3, 2, "456123"},
        {ORIENTATION_LEFTTOP, 2, 3, "142536"},  {ORIENTATION_RIGHTTOP, 2, 3, "415263"},
        {ORIENTATION_RIGHTBOT, 2, 3, "635241"}, {ORIENTATION_LEFTBOT, 2, 3, "362514"},
    };
    for (const Lying& lying : all)
        for (const auto& [bits, of_a_palette] : {std::pair{8, false}, {16, false}, {8, true}}) {
            INFO("orientation " << lying.orientation << ", " << bits << " bits, palette " << of_a_palette);
            const jit::Picture picture =
                six_texels(folder.file("lying.tif"), static_cast<uint16_t>(bits), lying.orientation, of_a_palette);
            CHECK(picture.error.empty());
            CHECK(picture.width == lying.width);
            CHECK(picture.height == lying.height);
            REQUIRE(picture.gray.size() == 6);
            std::string rows;
            for (int64_t row = picture.height; row-- > 0;) // a picture's begin at the bottom
                for (int64_t column = 0; column < picture.width; ++column)
                    rows += static_cast<char>(
                        '0' + std::lround(10 * picture.gray[static_cast<size_t>(row * picture.width + column)]));
            CHECK(rows == lying.rows);
        }
}
