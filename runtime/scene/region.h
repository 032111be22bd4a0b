// A part of space with a medium of its own: nothing to touch, but something to feel.
#pragma once

#include "runtime/geometry/placement.h"
#include "runtime/scene/vibration.h"

#include <cstdint>

namespace haptel::runtime {

enum class RegionShape : uint8_t { space, ball, box };

struct Region {
    RegionShape shape = RegionShape::space; // space: everywhere
    Placement placement;
    glm::dvec3 half_sides_m{0}; // of a box; of a ball, the radius three times
    double edge_m = 0;          // > 0: from the border inward the medium grows over this length to its full strength
    double damping_n_s_per_m = 0;
    Vibration vibration; // its direction turns with the region

    // How much of the medium is there, 0 outside to 1; continuous.
    double share_at(const glm::dvec3& p_m) const noexcept;
};

} // namespace haptel::runtime
