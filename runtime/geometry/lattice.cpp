#include "runtime/geometry/lattice.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

Lattice Lattice::around(const glm::dvec3& minimum_m, const glm::dvec3& maximum_m) noexcept
{
    Lattice lattice;
    lattice.centre_m = 0.5 * minimum_m + 0.5 * maximum_m;
    const glm::dvec3 half = maximum_m - lattice.centre_m;
    const double largest = std::max({half.x, half.y, half.z});
    int exponent = 0; // largest = f * 2^exponent with f in [1/2, 1)
    if (largest > 0) std::frexp(largest, &exponent);
    lattice.unit_m = std::ldexp(1.0, exponent - 40);
    return lattice;
}

bool Lattice::clip_to_cube(const glm::dvec3& from, const glm::dvec3& along, const glm::dvec3& middle, double reach,
                           double& enter, double& leave) noexcept
{
    for (int k = 0; k < 3; ++k) {
        const double low = middle[k] - reach - from[k], high = middle[k] + reach - from[k];
        if (along[k] == 0 && (low > 0 || high < 0)) return false;
        if (along[k] == 0) continue;
        enter = std::max(enter, std::min(low / along[k], high / along[k]));
        leave = std::min(leave, std::max(low / along[k], high / along[k]));
    }
    return enter <= leave;
}

bool Lattice::clip_to_workspace(glm::dvec3& from, glm::dvec3& to) noexcept
{
    from = glm::clamp(from, -0x1p100, 0x1p100); // of places farther away the way would not be finite
    to = glm::clamp(to, -0x1p100, 0x1p100);
    const glm::dvec3 start = from, along = to - from;
    double enter = 0, leave = 1;
    if (!clip_to_cube(start, along, glm::dvec3(0), workspace, enter, leave)) return false;
    const auto at = [&](double share) { return snap_units(share == 1 ? to : start + share * along); };
    const glm::dvec3 end = at(leave);
    from = at(enter);
    to = end;
    return true;
}

glm::dvec3 Lattice::snap_vertex(const glm::dvec3& point_m) const noexcept
{
    return glm::round(units(point_m) / vertex_spacing) * vertex_spacing;
}

} // namespace haptel::runtime
