#include "jit/picture/picture_grain.h"

#include "jit/picture/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace haptel::jit {

namespace {

// A finger at rest feels an edge of 0.85 um on a smooth plate (Johansson and LaMotte 1983, Tactile detection thresholds
// for a single asperity on an otherwise smooth surface).
constexpr double felt_edge_m = 1e-6;

std::string micrometres(double height_m)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2g um", height_m * 1e6);
    return text;
}

} // namespace

PictureGrain grain_of(const Picture& picture)
{
    const auto [darkest, brightest] = std::minmax_element(picture.gray.begin(), picture.gray.end());
    if (darkest == picture.gray.end()) return {};
    const double low = *darkest, high = *brightest;
    const bool has_shades = std::ranges::any_of(picture.gray, [&](double gray) { return low < gray && gray < high; });
    return {has_shades && picture.levels > 0 ? 1 / picture.levels : 0, picture.has_blocks};
}

std::vector<GrainNote> grain_notes(const PictureGrain& grain, const std::string& shown, double white_m)
{
    std::vector<GrainNote> notes;
    const double step_m = white_m * grain.level;
    if (std::isfinite(step_m) && step_m > felt_edge_m)
        notes.push_back({"'" + shown + "' has " + std::to_string(std::lround(1 / grain.level) + 1) +
                             " levels, so heights go in steps of " + micrometres(step_m) +
                             "; a hand feels edges from about " + micrometres(felt_edge_m) + " on",
                         "a file of 16 bits or of real numbers has no steps that can be felt"});
    if (grain.has_blocks)
        notes.push_back({"'" + shown + "' is coded in blocks of 8 x 8 texels, whose borders may be felt as a grid",
                         "use a PNG, TIFF or EXR made from the original; written anew, this one keeps its blocks"});
    return notes;
}

} // namespace haptel::jit
