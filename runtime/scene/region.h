// A part of space with a medium of its own: nothing to touch, but something to feel.
#pragma once

#include "runtime/geometry/placement.h"
#include "runtime/scene/vibration.h"

#include <algorithm>
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
    double share_at(const glm::dvec3& p_m) const noexcept
    {
        if (shape == RegionShape::space) return 1;
        const glm::dvec3 p = placement.to_object(p_m), inward = half_sides_m - glm::abs(p);
        const double depth_m =
            shape == RegionShape::ball ? half_sides_m.x - glm::length(p) : std::min({inward.x, inward.y, inward.z});
        return std::clamp(depth_m / edge_m, 0.0, 1.0);
    }
};

} // namespace haptel::runtime
