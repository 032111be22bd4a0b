// How long a texture takes where it will run: measured before a servo has to wait for it.
#pragma once

#include "lang/abi/texture_binding.h"

#include <string>

namespace haptel::jit {

class CompiledProgram;

// Share of a servo's period that one texture's call may take; the rest is contact, force, device, and reserve.
inline constexpr double share_of_period_max = 0.2;

// Why this binding, made for this request, is too slow for the request's servo, with the figure measured; empty: it is
// not, or no servo waits for it.
std::string too_slow(const TextureBinding& binding, const TextureRequest& request);

// The same of a binding of that program, whose code is optimised before it is refused.
std::string too_slow(const CompiledProgram& program, const TextureBinding& binding, const TextureRequest& request);

// Median time of one call of height_gradient over 1 000 random points of the box, seconds; fewer calls where they take
// more than a tenth of a second together. Faults the code's and the block's pages in on the way.
double median_call_s(const TextureBinding& binding, const double (&box_minimum_m)[3], const double (&box_maximum_m)[3]);

} // namespace haptel::jit
