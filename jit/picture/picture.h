// Pictures as numbers: what image_file.cpp asks of each kind of file.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::jit {

enum class Colours : bool { ignored, kept };

struct Picture {
    // Rows from the lowest up. Whole numbers of a file without a sign: 0 to 1, with a sign: -1 to 1; real ones as they
    // are. A colour counts by its brightness, transparency not at all.
    std::vector<double> gray = {};
    std::array<std::vector<double>, 4> colours =
        {}; // red, green, blue, alpha, if they are kept; empty: the file has none
    int64_t width = 0, height = 0;
    double levels = 0;       // steps from 0 to 1 that the file's whole numbers can take, 255 of 8 bits; 0: real numbers
    bool has_blocks = false; // coded as JPEG codes: in blocks of 8 x 8 texels, not exactly
    std::string error = {}, hint = {}; // why there is none; the former empty: there is one
};

// Bytes are anybody's: what is no picture, damaged or cut off is an error in words and never more.
Picture read_picture(std::string_view bytes,
                     Colours colours = Colours::ignored); // of any of the kinds below, by its first bytes

Picture read_pnm(std::string_view bytes, Colours colours = Colours::ignored); // PGM, PPM
Picture read_tiff(std::string_view bytes, Colours colours = Colours::ignored);
Picture read_exr(std::string_view bytes, Colours colours = Colours::ignored);
Picture read_common_picture(std::string_view bytes, Colours colours = Colours::ignored); // PNG, JPEG, BMP, TGA

Picture no_picture(std::string error, std::string hint = {});

// Asked before memory is taken for texels. Empty: no error yet, and a picture of that size, all 0.
Picture picture_of(int64_t width, int64_t height);
// What of a texel's samples put_texel() is to keep: of 1 or 2 gray, of 3 or 4 colours; of 2 or 4 the last is alpha.
void keep_colours(Picture& picture, size_t samples);

inline double brightness(double red, double green, double blue)
{
    return 0.299 * red + 0.587 * green + 0.114 * blue; // ITU-R BT.601
}

// A texel of so many samples, as keep_colours() has them.
inline void put_texel(Picture& picture, size_t at, std::span<const double> samples)
{
    const bool is_coloured = samples.size() >= 3;
    picture.gray[at] = is_coloured ? brightness(samples[0], samples[1], samples[2]) : samples[0];
    for (size_t i = 0; i < picture.colours.size(); ++i)
        if (!picture.colours[i].empty()) picture.colours[i][at] = i < 3 ? samples[i] : samples.back();
}

} // namespace haptel::jit
