// How far a point is from a triangle or a surface, by other means than those under test; and directions to look in.
#pragma once

#include "runtime/surface/surface.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace haptel::test {

inline glm::dvec3 random_direction(std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

// Distance of a point to a triangle, by convex combination: the nearest of the plane's foot, if that is inside, and
// the feet on the edges.
inline double distance_to(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p)
{
    const auto to_segment = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const glm::dvec3 along = to - from;
        const double t = glm::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0, 1.0);
        return glm::distance(p, from + t * along);
    };
    double least = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
    const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a)), foot = p - glm::dot(p - a, n) * n;
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::dot(glm::cross(to - from, foot - from), n) >= 0;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a)) least = std::min(least, std::abs(glm::dot(p - a, n)));
    return least;
}

inline double distance_to(const runtime::Surface& surface, const glm::dvec3& p)
{
    double least = INFINITY;
    for (uint32_t face = 0; face < surface.faces.size(); ++face)
        least = std::min(
            least, distance_to(surface.vertex_m(face, 0), surface.vertex_m(face, 1), surface.vertex_m(face, 2), p));
    return least;
}

} // namespace haptel::test
