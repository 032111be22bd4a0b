// How close and how fast one texture is in each precision, measured: so that the fastest that is close enough can be
// taken.
#pragma once

#include "jit/codegen/precision.h"
#include "lang/abi/texture_binding.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haptel::jit {

struct PrecisionFigures {
    Precision precision = Precision::f64;
    // Largest over the points against the 113-bit oracle, as a share of the largest true one.
    double height_error = 0, gradient_error = 0;
    // Median time of height and gradient: one point after the other, and many in a batch.
    double one_point_ns = 0, many_points_ns = 0;
};

struct PrecisionChoice {
    std::vector<PrecisionFigures> figures; // f64, mixed, f32
    std::string error;                     // why there are none
};

// Of one texture of a file, over the request's box with the request's values; random points as `haptel test` takes
// them. Code is compiled with full effort, and the times are taken in turns.
PrecisionChoice measure_precisions(const std::string& file, const std::string& texture, const TextureRequest& request,
                                   uint32_t points = 300);

// The fastest by `time` whose gradient error is at most that; null if none is.
const PrecisionFigures* fastest(const PrecisionChoice& choice, double PrecisionFigures::* time,
                                double gradient_error_max);

} // namespace haptel::jit
