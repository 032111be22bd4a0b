// Is the gradient of a texture the gradient of its height? Measured against independent truths, for `haptel test` and
// for applications' own tests.
//
// Points are uniform in a box, f64, in general position. Where a texture reads uv or n, these are affine functions of
// the point with their true Jacobians. Figures are relative to the largest true value over the points:
//   oracle      code against its IR interpreted over 113 bits
//   difference  code's gradient against central differences of the 113-bit height: step 2^-40 of the box and its half,
//               one Richardson step; stencils that take different branches, cells or sides of abs, min and max are
//               skipped and counted
#pragma once

#include "jit/texture/texture.h"
#include "lang/text/source.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::jit {

struct CheckBox {
    double minimum_m[3] = {-0.025, -0.025, -0.025};
    double maximum_m[3] = {0.025, 0.025, 0.025};
};
CheckBox box_of(const TextureRequest& request);

// Points that a fractal of five octaves passes in well under a second.
inline constexpr uint32_t default_check_points = 300;

// See jit/check/amplified_rounding.h.
struct AmplifiedRounding {
    double height = 0, gradient = 0; // what rounding alone makes of them: shares of the largest
    lang::Span span;                 // of the operation that most of it comes through; in CompiledProgram::sources()
    bool is_hash_of_sine = false;    // late digits of a sine or cosine are taken there
};

struct GradientCheck {
    uint32_t points = 0;
    std::optional<double> height_error_oracle;   // max |h - h_oracle| / max |h_oracle|
    std::optional<double> gradient_error_oracle; // max |g - g_oracle| / max |g_oracle|
    // The same of the oracle between the point and the point with each coordinate moved by half an ulp: what no f64
    // computation can be expected to resolve.
    std::optional<double> conditioning;
    std::optional<double> gradient_error_difference;
    uint32_t points_at_kinks = 0;
    double loop_integral_m =
        0;                   // largest |closed-loop integral of gradient . dp| over a few circles, quadrature included
    uint64_t not_finite = 0; // faults or values not finite, edge and huge points included
    uint64_t bounds_exceeded = 0;     // heights, slopes and changes of the gradient outside of the binding's facts
    uint32_t continuity_measured = 0; // HAPTEL_CONTINUITY_*: roughest met along short paths; 0: not looked at
    std::optional<AmplifiedRounding> amplified; // what the errors are of, where that is no fault
    std::vector<std::string> failures;          // in words, with place and values; empty: passed

    bool passed() const { return failures.empty(); }
};

// Height and gradient error of at most 1e-12 + 8 conditioning, differences that agree as well, at most 1 % of points at
// kinks, nothing not finite, nothing out of bounds, no rougher class than the facts say. Larger errors pass as
// `amplified` where 8 times as much as the texture makes of its own rounding accounts for them. `binding` was made from
// `program`, or wraps a texture of the same name and block. Uses all processors.
GradientCheck check_gradient(const std::shared_ptr<const CompiledProgram>& program, const TextureBinding& binding,
                             const CheckBox& box, uint32_t points = default_check_points, uint64_t seed = 1);

} // namespace haptel::jit
