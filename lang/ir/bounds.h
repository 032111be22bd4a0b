// What a function can return at most, over boxes of inputs and parameters: interval evaluation.
//
// Calls use the callee's facts (value, and slope around the middle of its first argument), intersected with natural
// evaluation of its body; `if` conditions that the intervals decide leave out the other arm, others narrow the values
// they compare inside each arm; loops run for every possible number of trips.
#pragma once

#include "lang/ir/interval.h"
#include "lang/ir/ir.h"

#include <span>
#include <vector>

namespace haptel::ir {

// Where a texture is asked about. All inputs that it reads must be set.
struct BoundsBox {
    Interval input[input_count] = {};
    std::vector<Interval> parameters; // by Texture::parameters; integers and booleans as numbers
};

// Height of the texture over the box, metres; infinite where not found. Includes 0 where the height may be not finite.
// Refined by bisecting point inputs, best first, until `evaluations` are spent or 5 % improvement per doubling is
// missed.
Interval height_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations = 4096);

// Every result of a function that is no entry, for arguments that lie in these intervals.
std::vector<Interval> function_bounds(const Module& module, uint32_t function, std::span<const Interval> arguments);

} // namespace haptel::ir
