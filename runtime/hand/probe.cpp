#include "runtime/hand/probe.h"

namespace haptel::runtime {

glm::dvec3 ProbeSettings::grip_of(const glm::dvec3& tip_m, const glm::dvec3& tail_m) const
{
    if (kind == ProbeKind::gripper) return 0.5 * tip_m + 0.5 * tail_m;
    const glm::dvec3 along = tail_m - tip_m;
    const double length = glm::length(along);
    return !grip_m ? tail_m : length > 0 ? tip_m + *grip_m / length * along : tip_m;
}

} // namespace haptel::runtime
