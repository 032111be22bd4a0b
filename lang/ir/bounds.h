// Interval evaluation: what a function can return at most, over boxes of inputs and parameters.
//
// Calls use the callee's facts, intersected with natural evaluation of its body; `if` conditions that the intervals
// decide leave out the other arm. Directed rounding is by widening each result by one ulp (elementary functions by
// four).
#pragma once

#include "lang/ir/ir.h"

namespace haptel::ir {

struct Interval {
    double minimum, maximum;
    bool may_be_nan = false; // a result that may be NaN or infinite; the entry turns it into 0
};

struct BoundsBox {
    Interval input[input_count];
    std::vector<Interval> parameters; // by Texture::parameters; integers and booleans as numbers
};

// Height of the texture over the box, metres; infinite where not found. Includes 0 where the height may be not finite.
// Refined by bisecting point inputs, best first, until `evaluations` are spent or 5 % improvement per doubling is
// missed.
Interval height_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations = 4096);

} // namespace haptel::ir
