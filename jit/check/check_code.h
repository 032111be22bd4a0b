// The part of a gradient check that needs nothing but the code: values that are not finite, bounds, loop integrals, and
// how heights and gradients change along short paths.
#pragma once

#include "jit/check/check_gradient.h"
#include "jit/check/check_points.h"

#include <string_view>

namespace haptel::jit {

// Share of the points at which a derivative may disagree: those that met a kink.
inline constexpr double kinks_share_max = 0.01;

// Adds a failure "what: found, allowed" unless `found` is at most `allowed`.
void expect_at_most(GradientCheck& check, std::string_view what, double found, double allowed);

// The greater error; one that is not a number counts as the greatest there is.
double greater(double a, double b);
// To the largest true value; where all are 0, the error as it is.
double relative(double error, double largest);

// Fills not_finite, bounds_exceeded, loop_integral_m and continuity_measured, with their failures. Looks at
// check.points random points.
void check_code(GradientCheck& check, const TextureBinding& binding, const CheckPoints& points);

} // namespace haptel::jit
