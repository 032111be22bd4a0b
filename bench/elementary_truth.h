// Arguments at which an elementary function may be wrong, and how far from the truth it is: for tests and figures.
#pragma once

#include "lang/ir/ir.h"
#include "lang/math/quad.h"

#include <utility>
#include <vector>

namespace haptel::ir {

std::vector<Op> elementary_ops();

// As code has them in single precision; the latter of an angle in double, for takes_angle(op).
float elementary_f32(Op op, float a, float b = 0);
float elementary_f32_of_angle(Op op, double a);

// Of what a double is exactly.
Quad elementary_truth(Op op, double a, double b = 0);

// Anywhere: `count` of each kind, such as every exponent, ordinary ranges, near multiples of a quarter turn, near 1,
// and where results overflow or become subnormal. The second counts for pow and atan2.
std::vector<std::pair<double, double>> elementary_arguments(Op op, int count);

// |found - exact| in units in the last place of the exact number; of an infinity, as if the exponents went on. Huge
// where one is NaN and the other not.
double units_off(double found, const Quad& exact);
double units_off(float found, const Quad& exact);

} // namespace haptel::ir
