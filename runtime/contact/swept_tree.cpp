#include "runtime/contact/swept_tree.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// Of the workspace: more than the products of a query can be off. The tree's boxes are widened themselves.
constexpr double box_rounding = 4 * Lattice::extent * 0x1p-21;

} // namespace

SweptRegion::SweptRegion(const glm::dvec3& tip0, const glm::dvec3& tail0, const glm::dvec3& tip1,
                         const glm::dvec3& tail1, double margin) noexcept
{
    const double wide = margin + box_rounding;
    minimum_ = glm::min(glm::min(tip0, tail0), glm::min(tip1, tail1)) - wide;
    maximum_ = glm::max(glm::max(tip0, tail0), glm::max(tip1, tail1)) + wide;
    const glm::dvec3 shaft = tail0 - tip0;
    const double length = glm::length(shaft);
    if (length == 0) return;
    const auto add = [&](const glm::dvec3& across) {
        const double size = glm::length(across);
        if (!(size > 0)) return;
        Axis& axis = axes_[axis_count_++];
        axis.direction = across / size;
        axis.absolute = glm::abs(axis.direction);
        const double at[] = {glm::dot(axis.direction, tip0), glm::dot(axis.direction, tail0),
                             glm::dot(axis.direction, tip1), glm::dot(axis.direction, tail1)};
        axis.low = std::min({at[0], at[1], at[2], at[3]}) - wide;
        axis.high = std::max({at[0], at[1], at[2], at[3]}) + wide;
    };
    const glm::dvec3 along = shaft / length;
    const glm::dvec3 from = 0.5 * (tip0 + tail0), to = 0.5 * (tip1 + tail1);
    add(glm::cross(along, to - from));
    for (int k = 0; k < 3; ++k) { // two of the three span what is across; each is the best against some boxes
        glm::dvec3 unit(0);
        unit[k] = 1;
        const glm::dvec3 across = glm::cross(along, unit);
        if (glm::dot(across, across) > 1e-6) add(across);
    }
}

} // namespace haptel::runtime
