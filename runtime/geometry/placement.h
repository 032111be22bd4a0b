// Where an object is.
#pragma once

#include "runtime/geometry/finite.h"

#include <glm/glm.hpp>

#include <string>

namespace haptel::runtime {

// Rotations made by others are rounded; what is farther from one scales or shears.
inline constexpr double orthonormal_within = 1e-6;

// Rotation and translation, nothing else: object space keeps its metres.
struct Placement {
    glm::dmat3 rotation{1}; // orthonormal
    glm::dvec3 position_m{0};

    glm::dvec3 to_world(const glm::dvec3& p) const { return rotation * p + position_m; }
    glm::dvec3 direction_to_world(const glm::dvec3& v) const { return rotation * v; }
    glm::dvec3 to_object(const glm::dvec3& p) const { return (p - position_m) * rotation; }
    glm::dvec3 direction_to_object(const glm::dvec3& v) const { return v * rotation; }
};

// Of turns about x first, then y, then z, in degrees.
glm::dmat3 rotation_about_axes(const glm::dvec3& turn_deg);

inline bool finite(const Placement& placement)
{
    return finite(placement.rotation[0]) && finite(placement.rotation[1]) && finite(placement.rotation[2]) &&
           finite(placement.position_m);
}

// Why it is none, to be put behind what it belongs to; empty: it is one.
std::string placement_fault(const Placement& placement);

} // namespace haptel::runtime
