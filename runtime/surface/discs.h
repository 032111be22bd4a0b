// How near to a place a part of a surface can be, without looking at its triangles: each node of the tree of boxes has
// a flat cylinder around all that is behind it. On a smooth surface that is as thin as the surface bends there, where a
// box is as thick as the surface is aslant.
#pragma once

#include "runtime/surface/box_tree.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haptel::runtime {

// The nearest point of a cylinder to a place, as the plane through it that separates both.
struct DiscBound {
    glm::dvec3 normal; // unit, toward the place
    double distance;   // 0: the place is within, and there is no such plane
};

inline DiscBound bound_of(const BoxTree::Disc& disc, const glm::dvec3& place) noexcept
{
    const glm::dvec3 axis = glm::normalize(glm::dvec3(disc.axis)), away = place - glm::dvec3(disc.centre);
    const double height = glm::dot(axis, away);
    const glm::dvec3 across = away - height * axis;
    const double length = glm::length(across);
    const double over = std::max(0.0, std::fabs(height) - disc.half_height),
                 beside = std::max(0.0, length - disc.radius);
    const glm::dvec3 way = std::copysign(over, height) * axis + (beside > 0 ? beside / length : 0.0) * across;
    const double distance = glm::length(way);
    return {distance > 0 ? way / distance : axis, distance};
}

// One for each node; of those with more than BoxTree::Disc::faces_most faces behind them an infinite one.
// `threads`: as many, or 0: one for each processor.
std::vector<BoxTree::Disc> discs_of(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces,
                                    const std::vector<BoxTree::Node>& nodes, unsigned threads);

} // namespace haptel::runtime
