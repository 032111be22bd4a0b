// Which triangles may a shaft meet on its way? Regions that are neither a segment nor a ball: all that lies between a
// few points, such as the four ends of a shaft before and after a move.
//
// It says yes in doubt and never no by mistake. Coordinates are lattice units. A query allocates nothing.
#pragma once

#include "runtime/surface/box_tree.h"

#include <array>
#include <cstdint>

namespace haptel::runtime {

// The convex hull of a shaft's ends before and after a straight move, and what is within `margin` of it; seen along a
// few axes only, so a little more.
class SweptRegion {
public:
    SweptRegion(const glm::dvec3& tip0, const glm::dvec3& tail0, const glm::dvec3& tip1, const glm::dvec3& tail1,
                double margin) noexcept;

    // The box around it.
    const glm::dvec3& low() const noexcept { return minimum_; }
    const glm::dvec3& high() const noexcept { return maximum_; }
    // Whether it may meet another that meets its own.
    bool may_meet(const glm::dvec3& box_centre, const glm::dvec3& box_half) const noexcept
    {
        for (uint32_t i = 0; i < axis_count_; ++i) {
            const double at = glm::dot(axes_[i].direction, box_centre), half = glm::dot(axes_[i].absolute, box_half);
            if (at + half < axes_[i].low || at - half > axes_[i].high) return false;
        }
        return true;
    }

private:
    struct Axis {
        glm::dvec3 direction, absolute;
        double low, high;
    };

    glm::dvec3 minimum_, maximum_;
    std::array<Axis, 4> axes_; // at right angles to the shaft, and to the plane that it sweeps
    uint32_t axis_count_ = 0;
};

// The surface's tree, asked for regions.
class SweptTree {
public:
    // Of a surface that lives longer.
    explicit SweptTree(const Surface& surface) : tree_(surface.tree.get()) {}

    // Calls visit(face) for each triangle whose box the region may meet, until that says false. Returns whether all
    // were visited.
    template <class Visit>
    bool for_each(const SweptRegion& region, Visit&& visit) const
    {
        return tree_->for_each(
            region.low(), region.high(),
            [&](const glm::dvec3& centre, const glm::dvec3& half) { return region.may_meet(centre, half); }, visit);
    }
    bool is_empty(const SweptRegion& region) const
    {
        return for_each(region, [](uint32_t) { return false; });
    }

private:
    const BoxTree* tree_;
};

} // namespace haptel::runtime
