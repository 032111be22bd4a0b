// From contact and texture to force: the published rules and the corrected one.
//
// `displaced` is the default because it is the only one that is conservative: on a flat base its force is minus the
// gradient of K/2 (d + h - h_max)^2, so no closed path of the hand gains energy. `paper` is the founding paper's
// k (AP . N) M with AP from the tip to the proxy, kept for comparison: it gives away K times depth change times height
// change on a loop.
// On a curved base `displaced` neglects the factor (I - d W)^-1 of the gradient, W the shape operator (relative error
// about depth times curvature).
#pragma once

#include "runtime/surface_texture.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string_view>

namespace haptel::runtime {

enum class ForceModel : uint8_t { displaced, paper };

std::string_view name_of(ForceModel model);
std::optional<ForceModel> force_model_named(std::string_view name);

// The contact as a force model sees it. Any frame, as long as it is one.
struct TouchedSurface {
    double depth_m = 0;                 // of the tip below the proxy along contact_normal, >= 0
    glm::dvec3 contact_normal{0, 0, 1}; // unit: the geometry's
    glm::dvec3 normal{0, 0, 1};         // unit, shaded: the direction of the force on a smooth surface
    double stiffness_n_per_m = 0;
};

struct ModelForce {
    glm::dvec3 force_n{0};
    double depth_m = 0; // below the surface that is felt; 0: no force. Friction and damping scale with it.
};

// Static force of the surface with its texture, before friction, damping and limits.
ModelForce model_force(ForceModel model, const TouchedSurface& surface, const TextureSample& texture) noexcept;

// `force` no longer than limit_n, direction kept.
glm::dvec3 limited(const glm::dvec3& force_n, double limit_n) noexcept;

} // namespace haptel::runtime
