// What the motors of a Falcon must do, by finite differences of the mechanism's closed inverse: another way than the
// driver's.
#pragma once

#include "device/falcon/falcon_kinematics.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptel::device {

// Counts of the encoders with the grip at this place, rounded as the sensors do.
inline std::array<int, 3> encoders_at(const glm::dvec3& place_m)
{
    const glm::dvec3 angles_rad = falcon_angles(place_m).value();
    std::array<int, 3> counts{};
    for (int arm = 0; arm < 3; ++arm) {
        const double degrees = angles_rad[arm] * 180 / 3.14159265358979323846;
        counts[static_cast<std::size_t>(arm)] =
            static_cast<int>(std::lround((degrees - 35) / (0.01425 / 0.110 * 360 / 1280)));
    }
    return counts;
}

// The place that the driver should find for such counts.
inline glm::dvec3 place_of(const std::array<int, 3>& encoders)
{
    glm::dvec3 angles_rad(0);
    for (int arm = 0; arm < 3; ++arm)
        angles_rad[arm] = (35 + encoders[static_cast<std::size_t>(arm)] * (0.01425 / 0.110 * 360 / 1280)) *
                          3.14159265358979323846 / 180;
    return falcon_place(angles_rad, falcon_centre_m).value().place_m;
}

// Motor counts for a force in the device's frame: torque i = force . d place / d angle i, by moving arm i a little.
inline glm::dvec3 expected_counts(const glm::dvec3& force_n, const glm::dvec3& place_m)
{
    const glm::dvec3 angles_rad = falcon_angles(place_m).value();
    constexpr double step_rad = 1e-5;
    glm::dvec3 counts(0);
    for (int arm = 0; arm < 3; ++arm) {
        glm::dvec3 more = angles_rad, less = angles_rad;
        more[arm] += step_rad;
        less[arm] -= step_rad;
        const glm::dvec3 way_m =
            falcon_place(more, place_m).value().place_m - falcon_place(less, place_m).value().place_m;
        counts[arm] = -10000 * glm::dot(force_n, way_m) / (2 * step_rad);
    }
    const double largest = std::max({std::abs(counts.x), std::abs(counts.y), std::abs(counts.z)});
    return largest > 4095 ? counts * (4095 / largest) : counts;
}

} // namespace haptel::device
