// From contact and texture to force: the published rules and the corrected one.
//
// K is the stiffness, d the depth of the tip below the base surface, N its unit normal, h the height of the texture at
// the foot with the lower or upper bound h_min, h_max that is proven for it, g the part of its gradient along the
// surface, and M = N - g the perturbed normal (equation 2; its length is meant).
//
//   displaced   K D (G - J^T grad h), D = max(d + h - h_max, 0), G = Foot::push, J^T by Foot::felt. Minus the gradient
//               of K/2 D^2: conservative, no closed path of the hand gains energy. The default.
//   paper       K (AP . N) M: Basdogan, Ho and Srinivasan, 1997, sec. 2.2 and 2.3, AP from the tip to the
//               contact. Not conservative: going round a loop gains K times change of depth times change of height.
//   paper_unit  K (AP . N) M / |M|, the same with a unit normal, as widely implemented: slopes add no force, only turn
//               it. Not conservative.
//   ho99        K ((AP . N) N - min(AP . N, h) g): Ho, Basdogan and Srinivasan, Presence 8(5), 1999, for h >= 0, which
//   a
//               texture below 0 is raised to. Conservative where d >= h, with K/2 (d^2 + h^2); shallower it is `paper`.
//               The tangential force does not grow with pressure.
//   lateral     K ((AP . N) N - min(AP . N, l) g): the lateral force of Minsky (thesis, 1995), -K l grad h, l a depth
//   of
//               choice below which the force begins without a step. Conservative where d >= l on a flat base, with
//               K/2 d^2 + K l h; shallower it is `paper`.
//
// What is conservative is so in a static scene, for a texture without time and without stiffness_scale (with equation
// (1) for shading on flat facets alone): stiffness that changes from point to point does work, up to its change times
// (d + h - h_max)^2 / 2.
#pragma once

#include "runtime/force/foot.h"
#include "runtime/scene/force_rule.h"
#include "runtime/texture/surface_texture.h"

#include <glm/glm.hpp>

namespace haptel::runtime {

struct ModelForce {
    glm::dvec3 force_n{0};
    double depth_m = 0; // below the surface that is felt; 0: no force. Friction and damping scale with it.
};

// Static force of the surface with its texture, before friction, damping and limits.
ModelForce model_force(const ForceRule& rule, const Foot& foot, double stiffness_n_per_m,
                       const TextureSample& texture) noexcept;

// `force` no longer than limit_n, direction kept.
glm::dvec3 limited(const glm::dvec3& force_n, double limit_n) noexcept;

} // namespace haptel::runtime
