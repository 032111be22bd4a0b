// The point of a triangle that is nearest to a given one (Ericson 2005, Real-Time Collision Detection, 5.1.5).
#pragma once

#include <glm/glm.hpp>

namespace haptel::runtime {

struct NearestPoint {
    glm::dvec3 at{0};
    glm::dvec3 barycentric{1, 0, 0}; // each >= 0, sum 1
};

inline NearestPoint nearest_point(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                                  const glm::dvec3& p) noexcept
{
    const auto at = [&](double u, double v, double w) { return NearestPoint{u * a + v * b + w * c, {u, v, w}}; };
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return at(1, 0, 0);
    const glm::dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return at(0, 1, 0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(1 - d1 / (d1 - d3), d1 / (d1 - d3), 0);
    const glm::dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return at(0, 0, 1);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(1 - d2 / (d2 - d6), 0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(0, 1 - w, w);
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return at(1, 0, 0);
    return at(1 - vb / sum - vc / sum, vb / sum, vc / sum);
}

} // namespace haptel::runtime
