// Where a shaft may come on a straight way: the convex hull of its ends before and after, and what is within `margin`
// of it, as a tree of boxes can be asked for it. Seen along a few axes only, so a little more; never less. Lattice
// units.
#pragma once

#include "runtime/surface/box_tree.h"

#include <array>
#include <cstdint>

namespace haptel::runtime {

class SweptRegion {
public:
    SweptRegion(const glm::dvec3& tip0, const glm::dvec3& tail0, const glm::dvec3& tip1, const glm::dvec3& tail1,
                double margin) noexcept;

    // A bit for each child of a node whose box it may meet.
    uint32_t met(const BoxTree::Node& node) const noexcept;
    // Whether it may meet the triangle itself.
    bool meets(const Surface& surface, uint32_t face) const noexcept;
    // Whether there is no triangle of which the tree would say so.
    bool is_empty(const BoxTree& tree) const noexcept
    {
        return tree.for_each(*this, [](uint32_t) { return false; });
    }

private:
    struct Axis {
        glm::vec3 direction;
        float low, high;
    };

    // In the tree's own numbers.
    glm::vec3 low_, high_;
    std::array<Axis, 3> axes_; // at right angles to the shaft, the first also to the plane that it sweeps
    uint32_t axis_count_ = 0;
};

} // namespace haptel::runtime
