#include "runtime/scene/region.h"

#include <algorithm>

namespace haptel::runtime {

double Region::share_at(const glm::dvec3& p_m) const noexcept
{
    if (shape == RegionShape::space) return 1;
    const glm::dvec3 p = placement.to_object(p_m);
    double depth_m = half_sides_m.x - glm::length(p);
    if (shape == RegionShape::box) {
        const glm::dvec3 inward = half_sides_m - glm::abs(p);
        depth_m = std::min({inward.x, inward.y, inward.z});
    }
    return std::clamp(depth_m / edge_m, 0.0, 1.0);
}

} // namespace haptel::runtime
