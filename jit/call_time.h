// How long a texture takes where it will run: measured before a servo has to wait for it.
#pragma once

#include "lang/texture_binding.h"

namespace haptel::jit {

// Median time of one call of height_gradient over 1 000 random points of the box, seconds; fewer calls where they take
// more than a tenth of a second together. Faults the code's and the block's pages in on the way.
double median_call_s(const TextureBinding& binding, const double (&box_minimum_m)[3], const double (&box_maximum_m)[3]);

} // namespace haptel::jit
