// What a function can return at most, over boxes of inputs and parameters: interval evaluation.
//
// Calls use the callee's facts (value, slope, curvature and class), intersected with natural evaluation of its body;
// `if` conditions that the intervals decide leave out the other arm, others narrow the values they compare inside each
// arm; loops run for every possible number of trips.
#pragma once

#include "lang/ir/bounds/interval.h"
#include "lang/ir/bounds/spline_image.h"
#include "lang/ir/bounds/variation.h"
#include "lang/ir/ir.h"

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace haptel::ir {

// Where a texture is asked about. All inputs that it reads must be set.
struct BoundsBox {
    Interval input[input_count] = {};
    std::vector<Interval> parameters; // by Texture::parameters; integers and booleans as numbers; of an image: any
    std::vector<const SplineImage*> images = {}; // likewise; null or missing: any image
    // Spectral norm of the normal's Jacobian, which says more than bounds of its nine numbers.
    double normal_turn_max_per_m = std::numeric_limits<double>::infinity();
    // Likewise of the length of each row of the Jacobian of uv.
    double uv_slope_max_per_m[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
};

// What tells of the contact itself: all that abi/contact_limits.h allows.
void set_contact(BoundsBox& box);

// Where a number may end: an operation whose operands are finite, and whose result, or its derivative as an entry
// computes it, may be not; or a constant that is not finite; or what takes too many operations to be looked at.
struct Undefined {
    enum class Why : uint8_t { domain, pole, overflow, derivative, not_looked_at };
    std::optional<Op> op; // nothing: a constant, or not looked at
    Why why;
    Interval operand; // the divisor, the radicand, ...
    Span span;        // innermost user code
};

// Declared facts that exclude what a body was shown to do.
struct FalseFact {
    enum class What : uint8_t { value, slope, curvature };
    Facts facts;
    What what;
    Interval found; // a value, where it is that
};

// What is known of a texture over a box; infinite where nothing was found.
struct TextureBounds {
    Interval height;            // metres; includes 0 where the height may be not finite
    double slope_max;           // sup of the Euclidean norm of the gradient by p; at jumps, of the smooth pieces
    double curvature_max_per_m; // sup of the Hessian's spectral norm; of a texture below C1, of the smooth pieces
    Continuity continuity;      // as a function of p
    Cause cause;                // of what makes it no smoother
    std::vector<std::string> declared; // functions whose facts these bounds believe, by name: declared, not proven
    std::vector<FalseFact> contradicted = {}; // of these
};

// Refined by bisecting point inputs and real parameters, best first, until `evaluations` are spent or 5 % improvement
// per doubling is missed.
TextureBounds texture_bounds(const Module& module, const Texture& texture, const BoundsBox& box,
                             uint32_t evaluations = 4096);
// What may set a fault bit somewhere in the box; empty where height, gradient and outputs are finite for certain. An
// input without bounds counts as some number, and so does what is sampled from an image that is not given. Not seen is
// what overflows within 1e-307 of a place where a derivative rule says 0 in place of what has no bound, as beside the
// origin of atan2(y, x).
std::vector<Undefined> undefined_in(const Module& module, const Texture& texture, const BoundsBox& box,
                                    uint32_t evaluations = 512);
// Where in the box, by Input, the least and the greatest height may be: in the piece whose bound is the greatest, cut
// on into the half with the greater bound. If the bounds are true, there are such heights near by. Inputs that have no
// bounds, or are not read, are 0.
struct HeightPlaces {
    double lowest[input_count] = {}, highest[input_count] = {};
};
// Of intervals, in all, at some 100 ns each: keeps a check short, whatever the program.
inline constexpr uint64_t operations_of_check = 3'000'000;
// Its height alone, which is cheaper. `places`, where given, is to be called afterwards for its places, which take
// longer than the bounds of most textures do; the module outlives it.
Interval height_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations = 4096,
                       uint64_t operations = operations_of_check, std::function<HeightPlaces()>* places = nullptr);

// Its material outputs, by bit of Texture::writes. One that may be NaN says so; the rest holds where it is a number.
std::vector<Interval> output_bounds(const Module& module, const Texture& texture, const BoundsBox& box,
                                    uint32_t evaluations = 4096);

} // namespace haptel::ir
