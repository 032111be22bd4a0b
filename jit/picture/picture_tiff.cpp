#include "jit/picture/picture.h"

#include <Imath/half.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

namespace haptel::jit {

namespace {

constexpr const char* readable = "TIFF of 8, 16 or 32 bits, gray or RGB, whole numbers or real ones";

// Of one allocation that a file asks for: the largest picture in one strip, 4 channels of 32 bits.
constexpr tmsize_t memory_max = (tmsize_t{16} << 24) + (1 << 20);

// The file in memory, and the first thing that the library says of it.
struct Source {
    std::string_view bytes;
    uint64_t at = 0;
    std::string said;
};

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t count)
{
    auto& source = *static_cast<Source*>(handle);
    const uint64_t left = source.at < source.bytes.size() ? source.bytes.size() - source.at : 0;
    const auto taken = std::min<uint64_t>(left, static_cast<uint64_t>(std::max<tmsize_t>(count, 0)));
    if (taken > 0) std::memcpy(to, source.bytes.data() + source.at, taken);
    source.at += taken;
    return static_cast<tmsize_t>(taken);
}

toff_t seek(thandle_t handle, toff_t offset, int from)
{
    auto& source = *static_cast<Source*>(handle);
    source.at = from == SEEK_SET ? offset : from == SEEK_CUR ? source.at + offset : source.bytes.size() + offset;
    return source.at;
}

tmsize_t write_nothing(thandle_t, void*, tmsize_t)
{
    return 0;
}

int close_nothing(thandle_t)
{
    return 0;
}

toff_t size_of(thandle_t handle)
{
    return static_cast<Source*>(handle)->bytes.size();
}

int listen(TIFF*, void* source, const char*, const char* format, va_list arguments)
{
    std::string& said = static_cast<Source*>(source)->said;
    char text[200] = "";
    if (said.empty()) {
        std::vsnprintf(text, sizeof text, format, arguments);
        said = text;
    }
    return 1; // told: no handler of the process need be
}

int ignore(TIFF*, void*, const char*, const char*, va_list)
{
    return 1;
}

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;

Tiff open(Source& source)
{
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                               TIFFOpenOptionsFree);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), memory_max);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), listen, &source);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore, nullptr);
    return {TIFFClientOpenExt("picture", "rm", &source, read_bytes, write_nothing, seek, close_nothing, size_of,
                              nullptr, nullptr, options.get()),
            TIFFClose};
}

struct Layout {
    uint32_t width = 0, height = 0;
    uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG, meaning = 0,
             orientation = ORIENTATION_TOPLEFT;
    bool has_meaning = false, tiled = false;

    explicit Layout(TIFF* tiff) : tiled(TIFFIsTiled(tiff) != 0)
    {
        TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
        TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planes);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &orientation);
        has_meaning = TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &meaning) != 0;
        if (format == SAMPLEFORMAT_VOID) format = SAMPLEFORMAT_UINT;
    }
    // Steps from 0 to 1 of what is read; 0: real numbers.
    double levels() const
    {
        if (!is_plain()) return UINT8_MAX; // read_converted
        if (is_real()) return 0;
        return std::exp2(format == SAMPLEFORMAT_INT ? bits - 1 : bits) - 1;
    }
    bool is_real() const { return format == SAMPLEFORMAT_IEEEFP; }
    bool is_rgb() const { return has_meaning && meaning == PHOTOMETRIC_RGB && samples >= 3; }
    // The file's rows are the picture's columns.
    bool is_turned() const { return orientation >= ORIENTATION_LEFTTOP && orientation <= ORIENTATION_LEFTBOT; }
    // Where in the picture, whose rows begin at the bottom, a pixel of the file belongs.
    size_t place(size_t row, size_t column) const
    {
        const bool from_right = orientation == ORIENTATION_TOPRIGHT || orientation == ORIENTATION_BOTRIGHT,
                   from_bottom = orientation == ORIENTATION_BOTRIGHT || orientation == ORIENTATION_BOTLEFT;
        const bool turned_from_right = orientation == ORIENTATION_RIGHTTOP || orientation == ORIENTATION_RIGHTBOT,
                   turned_from_bottom = orientation == ORIENTATION_RIGHTBOT || orientation == ORIENTATION_LEFTBOT;
        if (is_turned()) {
            const size_t x = turned_from_right ? height - 1 - row : row;
            return (turned_from_bottom ? column : width - 1 - column) * height + x;
        }
        const size_t x = from_right ? width - 1 - column : column;
        return (from_bottom ? row : height - 1 - row) * width + x;
    }
    // Whether the samples are read as they are, all their bits.
    bool is_plain() const
    {
        const bool whole =
            (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT) && (bits == 8 || bits == 16 || bits == 32);
        const bool gray = !has_meaning || meaning == PHOTOMETRIC_MINISBLACK || meaning == PHOTOMETRIC_MINISWHITE;
        return samples >= 1 && (whole || (is_real() && (bits == 16 || bits == 32 || bits == 64))) && (gray || is_rgb());
    }
};

template <class Number>
Number bits_at(const std::byte* at)
{
    Number value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

template <class Number>
double number_at(const std::byte* at, double unit)
{
    return static_cast<double>(bits_at<Number>(at)) / unit;
}

double sample_at(const Layout& layout, const std::byte* at)
{
    const bool is_signed = layout.format == SAMPLEFORMAT_INT;
    if (layout.is_real()) {
        switch (layout.bits) {
        case 16: return static_cast<double>(imath_half_to_float(bits_at<uint16_t>(at)));
        case 32: return number_at<float>(at, 1);
        default: return number_at<double>(at, 1);
        }
    }
    switch (layout.bits) {
    case 8: return is_signed ? number_at<int8_t>(at, INT8_MAX) : number_at<uint8_t>(at, UINT8_MAX);
    case 16: return is_signed ? number_at<int16_t>(at, INT16_MAX) : number_at<uint16_t>(at, UINT16_MAX);
    default: return is_signed ? number_at<int32_t>(at, INT32_MAX) : number_at<uint32_t>(at, UINT32_MAX);
    }
}

// A block of the file, a row or a tile: `planes` of them side by side where colours are stored apart.
struct Block {
    std::vector<std::byte> bytes;
    size_t plane_size;
    const Layout& layout;

    double gray(size_t pixel) const
    {
        const size_t size = layout.bits / 8;
        const bool apart = layout.planes == PLANARCONFIG_SEPARATE;
        const auto sample = [&](size_t i) {
            return sample_at(layout, bytes.data() +
                                         (apart ? i * plane_size + pixel * size : (pixel * layout.samples + i) * size));
        };
        if (layout.is_rgb()) return brightness(sample(0), sample(1), sample(2));
        const double value = sample(0);
        const bool inverted = layout.has_meaning && layout.meaning == PHOTOMETRIC_MINISWHITE && !layout.is_real();
        return inverted ? 1 - value : value;
    }
};

// Reads block by block: `read(plane, to)` one of them, `put(block)` uses it.
template <class Read>
bool fill(Block& block, Read&& read)
{
    const uint16_t planes = block.layout.planes == PLANARCONFIG_SEPARATE && block.layout.is_rgb() ? 3 : 1;
    for (uint16_t plane = 0; plane < planes; ++plane)
        if (!read(plane, block.bytes.data() + plane * block.plane_size)) return false;
    return true;
}

bool read_plain(TIFF* tiff, const Layout& layout, Picture& made)
{
    uint32_t across = layout.width, down = 1;
    if (layout.tiled) {
        if (!TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &across) || !TIFFGetField(tiff, TIFFTAG_TILELENGTH, &down))
            return false;
    }
    const tmsize_t size = layout.tiled ? TIFFTileSize(tiff) : TIFFScanlineSize(tiff);
    const uint64_t pixel_bytes =
        uint64_t{layout.bits} / 8 * (layout.planes == PLANARCONFIG_SEPARATE ? 1u : layout.samples);
    if (across < 1 || down < 1 || size < 1 || size > memory_max / 3) return false;
    if (static_cast<uint64_t>(size) < uint64_t{across} * down * pixel_bytes) return false;
    Block block{std::vector<std::byte>(3 * static_cast<size_t>(size)), static_cast<size_t>(size), layout};

    for (uint32_t top = 0; top < layout.height; top += down)
        for (uint32_t left = 0; left < layout.width; left += across) {
            const bool whole = fill(block, [&](uint16_t plane, std::byte* to) {
                return layout.tiled ? TIFFReadTile(tiff, to, left, top, 0, plane) >= 0
                                    : TIFFReadScanline(tiff, to, top, plane) >= 0;
            });
            if (!whole) return false;
            for (uint32_t y = 0; y < std::min(down, layout.height - top); ++y)
                for (uint32_t x = 0; x < std::min(across, layout.width - left); ++x)
                    made.gray[layout.place(top + y, left + x)] = block.gray(size_t{y} * across + x);
        }
    return true;
}

// What is packed, indexed or compressed as colours, in 8 bits.
bool read_converted(TIFF* tiff, const Layout& layout, Picture& made)
{
    std::vector<uint32_t> pixels(made.gray.size());
    // Asked for in its own orientation it comes in the order of the file: the library turns no rows into columns.
    if (!TIFFReadRGBAImageOriented(tiff, layout.width, layout.height, pixels.data(), layout.orientation, 1))
        return false;
    for (size_t i = 0; i < pixels.size(); ++i)
        made.gray[layout.place(i / layout.width, i % layout.width)] =
            brightness(TIFFGetR(pixels[i]), TIFFGetG(pixels[i]), TIFFGetB(pixels[i])) / 255;
    return true;
}

} // namespace

bool is_tiff(std::string_view bytes)
{
    using namespace std::string_view_literals;
    const std::string_view head = bytes.substr(0, 4);
    return head == "II*\0"sv || head == "MM\0*"sv || head == "II+\0"sv || head == "MM\0+"sv;
}

Picture read_tiff(std::string_view bytes)
{
    Source source{bytes, 0, {}};
    const Tiff tiff = open(source);
    const auto damaged = [&] {
        return no_picture("is damaged" + (source.said.empty() ? "" : ": " + source.said), readable);
    };
    if (!tiff) return damaged();
    const Layout layout(tiff.get());
    Picture made =
        layout.is_turned() ? picture_of(layout.height, layout.width) : picture_of(layout.width, layout.height);
    if (!made.error.empty()) return made;
    uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_COMPRESSION, &compression);
    made.levels = layout.levels();
    made.has_blocks = compression == COMPRESSION_JPEG || compression == COMPRESSION_OJPEG;
    if (layout.is_plain()) return read_plain(tiff.get(), layout, made) ? made : damaged();
    char reason[1024] = "";
    if (!TIFFRGBAImageOK(tiff.get(), reason))
        return no_picture("is a TIFF of a kind that is not read, of " + std::to_string(layout.bits) +
                              " bits a sample, " + (layout.is_real() ? "real" : "whole") + ": " + reason,
                          readable);
    return read_converted(tiff.get(), layout, made) ? made : damaged();
}

} // namespace haptel::jit
