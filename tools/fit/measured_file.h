// What was measured of a surface, from a file: a picture of heights, or a table of a stroke.
#pragma once

#include "jit/fit/fit.h"

#include <string>

namespace haptel::tools {

struct MeasuredHeights {
    jit::HeightMap map;
    std::string error, hint; // the former empty: there is a map
};
// Black is the height 0, white `white_m`; of a picture of real numbers `white_m` is the height of 1.
MeasuredHeights read_heights(const std::string& file, double pixel_m, double white_m);

struct MeasuredStroke {
    jit::Stroke stroke; // rate and passes; what they are of
    std::string error, hint;
};
// A CSV table with a header: time_s, at even distances within each pass and a gap between two, and force_n, fz_n (of a
// trace of `haptel explore` over a plane) or acceleration_m_per_s2.
MeasuredStroke read_stroke(const std::string& file);

// Ends like a table and not like a picture.
bool is_stroke_file(const std::string& file);

} // namespace haptel::tools
