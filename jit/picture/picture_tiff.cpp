#include "jit/picture/picture.h"

#include <Imath/half.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

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

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;

Tiff open(Source& source)
{
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                               TIFFOpenOptionsFree);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), memory_max);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), listen, &source);
    const auto ignore = [](TIFF*, void*, const char*, const char*, va_list) { return 1; };
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore, nullptr);
    const auto write_nothing = [](thandle_t, void*, tmsize_t) -> tmsize_t { return 0; };
    const auto close_nothing = [](thandle_t) { return 0; };
    return {TIFFClientOpenExt("picture", "rm", &source, read_bytes, write_nothing, seek, close_nothing, size_of,
                              nullptr, nullptr, options.get()),
            TIFFClose};
}

struct Layout {
    uint32_t width = 0, height = 0;
    uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG,
             meaning = PHOTOMETRIC_MINISBLACK, orientation = ORIENTATION_TOPLEFT;
    bool tiled = false;

    explicit Layout(TIFF* tiff) : tiled(TIFFIsTiled(tiff) != 0)
    {
        TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
        TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planes);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &orientation);
        TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &meaning);
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
    bool is_rgb() const { return meaning == PHOTOMETRIC_RGB && samples >= 3; }
    // The sample that is alpha; 0: none is. Others beside the colours may be anything.
    uint16_t alpha(TIFF* tiff) const
    {
        uint16_t count = 0;
        const uint16_t* kinds = nullptr;
        if (!TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds) || count >= samples) return 0;
        for (uint16_t i = 0; i < count; ++i)
            if (kinds[i] == EXTRASAMPLE_ASSOCALPHA || kinds[i] == EXTRASAMPLE_UNASSALPHA)
                return static_cast<uint16_t>(samples - count + i);
        return 0;
    }
    // The file's rows are the picture's columns.
    bool is_turned() const { return orientation >= ORIENTATION_LEFTTOP; }
    // Where in the picture, whose rows begin at the bottom, a pixel of the file belongs.
    size_t place(size_t row, size_t column) const
    {
        // ORIENTATION_TOPLEFT, TOPRIGHT, BOTRIGHT, BOTLEFT, and the same of rows and columns that change places
        const int way = (orientation - 1) % 4;
        const bool from_right = way == 1 || way == 2, from_bottom = way == 2 || way == 3;
        size_t across = width, down = height;
        if (is_turned()) {
            std::swap(row, column);
            std::swap(across, down);
        }
        return (from_bottom ? row : down - 1 - row) * across + (from_right ? across - 1 - column : column);
    }
    // Whether the samples are read as they are, all their bits.
    bool is_plain() const
    {
        const bool whole =
            (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT) && (bits == 8 || bits == 16 || bits == 32);
        const bool gray = meaning == PHOTOMETRIC_MINISBLACK || meaning == PHOTOMETRIC_MINISWHITE;
        return samples >= 1 && (whole || (is_real() && (bits == 16 || bits == 32 || bits == 64))) && (gray || is_rgb());
    }
};

template <class Number>
Number number_at(const std::byte* at)
{
    Number value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

// 0 to 1, or -1 to 1 with a sign.
template <class Whole>
double share_at(const std::byte* at)
{
    return static_cast<double>(number_at<Whole>(at)) / std::numeric_limits<Whole>::max();
}

double sample_at(const Layout& layout, const std::byte* at)
{
    if (layout.is_real())
        return layout.bits == 16   ? static_cast<double>(imath_half_to_float(number_at<uint16_t>(at)))
               : layout.bits == 32 ? static_cast<double>(number_at<float>(at))
                                   : number_at<double>(at);
    const bool is_signed = layout.format == SAMPLEFORMAT_INT;
    if (layout.bits == 8) return is_signed ? share_at<int8_t>(at) : share_at<uint8_t>(at);
    if (layout.bits == 16) return is_signed ? share_at<int16_t>(at) : share_at<uint16_t>(at);
    return is_signed ? share_at<int32_t>(at) : share_at<uint32_t>(at);
}

// Block by block, a row or a tile: several of them side by side where colours are stored apart.
bool read_plain(TIFF* tiff, const Layout& layout, Picture& made, Colours kept)
{
    uint32_t across = layout.width, down = 1;
    if (layout.tiled &&
        (!TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &across) || !TIFFGetField(tiff, TIFFTAG_TILELENGTH, &down)))
        return false;
    const tmsize_t bytes = layout.tiled ? TIFFTileSize(tiff) : TIFFScanlineSize(tiff);
    if (across < 1 || down < 1 || bytes < 1) return false;
    const bool is_apart = layout.planes == PLANARCONFIG_SEPARATE;
    const auto plane_size = static_cast<size_t>(bytes);
    const size_t sample_size = layout.bits / 8, pixel_size = sample_size * (is_apart ? 1 : layout.samples);
    if (plane_size < uint64_t{across} * down * pixel_size) return false;
    const auto lights = static_cast<uint16_t>(layout.is_rgb() ? 3 : 1);
    const uint16_t alpha = kept == Colours::kept ? layout.alpha(tiff) : 0;
    const auto samples = static_cast<uint16_t>(lights + (alpha > 0));
    if (kept == Colours::kept) keep_colours(made, samples);
    const auto planes = static_cast<uint16_t>(is_apart ? samples : 1);
    if (bytes > memory_max / planes) return false;
    const bool is_inverted = layout.meaning == PHOTOMETRIC_MINISWHITE && !layout.is_real();
    std::vector<std::byte> block(planes * plane_size);
    const auto put = [&](size_t place, size_t pixel) {
        const auto sample = [&](size_t i) {
            const size_t behind = is_apart ? i * plane_size : (i < lights ? i : alpha) * sample_size;
            return sample_at(layout, block.data() + pixel * pixel_size + behind);
        };
        double values[4] = {};
        for (size_t i = 0; i < samples; ++i) values[i] = sample(i);
        if (is_inverted) values[0] = 1 - values[0];
        put_texel(made, place, {values, samples});
    };

    for (uint32_t top = 0; top < layout.height; top += down)
        for (uint32_t left = 0; left < layout.width; left += across) {
            for (uint16_t plane = 0; plane < planes; ++plane) {
                std::byte* const to = block.data() + plane * plane_size;
                const uint16_t from = plane < lights ? plane : alpha;
                const tmsize_t got =
                    layout.tiled ? TIFFReadTile(tiff, to, left, top, 0, from) : TIFFReadScanline(tiff, to, top, from);
                if (got < 0) return false;
            }
            for (uint32_t y = 0; y < std::min(down, layout.height - top); ++y)
                for (uint32_t x = 0; x < std::min(across, layout.width - left); ++x)
                    put(layout.place(top + y, left + x), size_t{y} * across + x);
        }
    return true;
}

// What is packed, indexed or compressed as colours, in 8 bits.
bool read_converted(TIFF* tiff, const Layout& layout, Picture& made, Colours kept)
{
    if (kept == Colours::kept) keep_colours(made, 4);
    std::vector<uint32_t> pixels(made.gray.size());
    // Asked for in its own orientation it comes in the order of the file: the library turns no rows into columns.
    if (!TIFFReadRGBAImageOriented(tiff, layout.width, layout.height, pixels.data(), layout.orientation, 1))
        return false;
    for (size_t i = 0; i < pixels.size(); ++i) {
        const uint32_t pixel = pixels[i];
        const double samples[] = {TIFFGetR(pixel) / 255.0, TIFFGetG(pixel) / 255.0, TIFFGetB(pixel) / 255.0,
                                  TIFFGetA(pixel) / 255.0};
        put_texel(made, layout.place(i / layout.width, i % layout.width), samples);
    }
    return true;
}

} // namespace

Picture read_tiff(std::string_view bytes, Colours colours)
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
    if (layout.is_plain()) return read_plain(tiff.get(), layout, made, colours) ? made : damaged();
    char reason[1024] = "";
    if (!TIFFRGBAImageOK(tiff.get(), reason))
        return no_picture("is a TIFF of a kind that is not read, of " + std::to_string(layout.bits) +
                              " bits a sample, " + (layout.is_real() ? "real" : "whole") + ": " + reason,
                          readable);
    return read_converted(tiff.get(), layout, made, colours) ? made : damaged();
}

} // namespace haptel::jit
