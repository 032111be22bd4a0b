// Which triangles may a shaft meet on its way? A tree of boxes for regions that are neither a segment nor a ball: all
// that lies between a few points, such as the four ends of a shaft before and after a move.
//
// It says yes in doubt and never no by mistake. Coordinates are lattice units. Built once; a query allocates nothing.
#pragma once

#include "runtime/surface/surface.h"

#include <array>
#include <cstdint>
#include <vector>

namespace haptel::runtime {

// The convex hull of a shaft's ends before and after a straight move, and what is within `margin` of it; seen along a
// few axes only, so a little more.
class SweptRegion {
public:
    SweptRegion(const glm::dvec3& tip0, const glm::dvec3& tail0, const glm::dvec3& tip1, const glm::dvec3& tail1,
                double margin) noexcept;

    bool may_meet(const glm::dvec3& box_centre, const glm::dvec3& box_half) const noexcept
    {
        if (glm::any(glm::lessThan(box_centre + box_half, minimum_)) ||
            glm::any(glm::greaterThan(box_centre - box_half, maximum_)))
            return false;
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

class SweptTree {
public:
    explicit SweptTree(const Surface& surface);

    // Calls visit(face) for each triangle whose box the region may meet, until that says false. Returns whether all
    // were visited.
    template <class Visit>
    bool for_each(const SweptRegion& region, Visit&& visit) const
    {
        uint32_t stack[64];
        uint32_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const uint32_t index = stack[--top];
            const Node& node = nodes_[index];
            if (!region.may_meet(node.centre, node.half)) continue;
            if (node.second != 0) {
                stack[top++] = node.second;
                stack[top++] = index + 1;
                continue;
            }
            for (uint32_t i = node.begin; i < node.end; ++i)
                if (region.may_meet(boxes_[i].centre, boxes_[i].half) && !visit(boxes_[i].face)) return false;
        }
        return true;
    }

    bool is_empty(const SweptRegion& region) const
    {
        return for_each(region, [](uint32_t) { return false; });
    }

private:
    struct Node {
        glm::vec3 centre, half;
        uint32_t begin, end; // of boxes_, in a leaf
        uint32_t second = 0; // the other child; the first is the next node; 0: a leaf
    };
    struct Box {
        glm::vec3 centre, half;
        uint32_t face;
    };

    void build(uint32_t begin, uint32_t end);

    std::vector<Box> boxes_;
    std::vector<Node> nodes_;
};

} // namespace haptel::runtime
