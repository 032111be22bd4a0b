// The point of a triangle that is nearest to a given one (Ericson 2005, Real-Time Collision Detection, 5.1.5).
#pragma once

#include <glm/glm.hpp>

namespace haptel::runtime {

struct NearestPoint {
    glm::dvec3 at{0};
    glm::dvec3 barycentric{1, 0, 0}; // each >= 0, sum 1
};

NearestPoint nearest_point(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) noexcept;

} // namespace haptel::runtime
