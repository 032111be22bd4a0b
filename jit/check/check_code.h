// The part of a gradient check that needs nothing but the code: values that are not finite, bounds, loop integrals, and
// how heights and gradients change along short paths.
#pragma once

#include "jit/check/check_gradient.h"
#include "jit/check/check_points.h"

#include <functional>
#include <string>
#include <string_view>

namespace haptel::jit {

// Share of the points at which a derivative may disagree: those that met a kink.
inline constexpr double kinks_share_max = 0.01;

// Adds a failure "what: found, allowed; where" unless `found` is at most `allowed`; `where` is asked only then.
void expect_at_most(GradientCheck& check, std::string_view what, double found, double allowed,
                    const std::function<std::string()>& where = {});

// With as few digits as give the same number again, so that `haptel eval --at` sees what was seen.
std::string shortest(double value);
std::string listed(const double (&numbers)[3]); // "1,2,3"

// The greater error; one that is not a number counts as the greatest there is.
double greater(double a, double b);
// To the largest true value; where all are 0, the error as it is.
double relative(double error, double largest);

// Fills not_finite, bounds_exceeded, loop_integral_m and continuity_measured, with their failures. Looks at
// check.points random points.
void check_code(GradientCheck& check, const TextureBinding& binding, const CheckPoints& points);

} // namespace haptel::jit
