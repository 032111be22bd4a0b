// The part of a gradient check that looks at how heights and gradients change along short paths: class, slope and
// curvature as measured, against what the binding's facts promise.
#pragma once

#include "jit/check/check_gradient.h"
#include "jit/check/check_points.h"

namespace haptel::jit {

// Fills continuity_measured, and adds to bounds_exceeded and failures where the facts promise more.
void check_continuity(GradientCheck& check, const TextureBinding& binding, const CheckPoints& points);

} // namespace haptel::jit
