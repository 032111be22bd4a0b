// Where a texture makes its own rounding large: fract(sin(x) * 43758.5) shows the digits that a sine does not have.
//
// f64 rounds every operation by half of its last digit. Most textures keep errors of that size. Where an operation
// folds its argument (floor, fract, mod, sin ...) what is left is the last digits of a large number, and an error in
// them is as much larger than before as the number was. Such a height is what its author wrote, in every precision a
// different one, and no fault of the compiler's.
//
// Measured, not proven: the texture is interpreted over 113 bits but for those operations, which are done in f64. Other
// operations are never excused: a derivative that cancels itself stays a fault.
#pragma once

#include "jit/check/check_points.h"

#include <optional>

namespace haptel::jit {

// Over the same points as check_gradient(), whose largest true values are given: of the height, in metres, and of the
// gradient. Nothing where no operation folds anything, or nothing comes of it.
std::optional<AmplifiedRounding> amplified_rounding(const CompiledProgram& program, const TextureBinding& binding,
                                                    const CheckPoints& points, uint32_t count, double largest_height_m,
                                                    double largest_gradient);

} // namespace haptel::jit
