// What a pixel shows: the mean over its area, from as many samples as the texture's finest features need.
//
// One sample to a pixel shows features finer than two pixels as coarser ones that are not there. How fine they are is
// measured, along x and along y, as the distance within which the texture changes: bounds of the slope hold for the
// steepest place alone, and say nothing of what repeats.
#pragma once

#include "tools/plot/plot_texture.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace haptel::tools::plot {

// A square picture: what it shows at (x, y) metres from its middle, x to the right and y up. Nothing: background.
struct Canvas {
    double side_m = 0;
    int pixels = 0; // each way
    std::function<std::optional<haptel_point>(const glm::dvec2&)> point;
    std::function<void(std::span<const haptel_point>, std::span<haptel_sample>)> samples; // any thread

    double pixel_m() const { return side_m / pixels; }
};

// The plane of a view, so many pixels each way.
Canvas canvas_of(const TextureView& view, int pixels);

enum class Shown : uint8_t { height, gradient };

struct Fineness {
    double feature_m = 0; // the length of the waves that most of it is made of at its finest
    int each_way = 1;     // samples per pixel that show it: four to a wave; at most `samples_most`
};

inline constexpr int samples_most = 16; // each way: 256 to a pixel are seconds, and as smooth as 8 bits of colour show

Fineness fineness(const Canvas& canvas, Shown what);

// One line to whoever looks, where features are finer than two pixels: how fine, what was done, and what shows them.
void tell_fineness(const TextureView& view, const Canvas& canvas, const Fineness& fine, const std::string& done,
                   std::string_view pixels = "pixels");
std::string averaged(const Fineness& fine); // "64 samples averaged per pixel"

// Calls `draw` for each pixel, by rows from the top, on all of the machine's processors: with its samples, and with how
// many belong to the background. More than 2 each way are at random within equal parts of the pixel, so that what is
// finer still is noise and not a pattern.
struct PixelSamples {
    int column, row;
    std::span<const haptel_point> points;
    std::span<const haptel_sample> samples;
    int background;
};
void for_each_pixel(const Canvas& canvas, int samples_each_way, const std::function<void(const PixelSamples&)>& draw);

} // namespace haptel::tools::plot
