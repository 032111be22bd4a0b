#include "runtime/contact/swept_tree.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr uint32_t leaf_size = 4;

// Of the workspace: more than single precision and the products of a query can be off.
constexpr double box_rounding = 4 * Lattice::extent * 0x1p-21;

// Halves rounded to float lose less than this of a box.
glm::vec3 widened(const glm::dvec3& half)
{
    return glm::vec3(half + Lattice::extent * 0x1p-22);
}

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

const SweptTree& Surface::swept_tree() const
{
    std::call_once(swept_tree_made_, [this] { swept_tree_ = std::make_shared<const SweptTree>(*this); });
    return *swept_tree_;
}

SweptTree::SweptTree(const Surface& surface)
{
    boxes_.reserve(surface.faces.size());
    for (uint32_t f = 0; f < surface.faces.size(); ++f) {
        const auto& corners = surface.faces[f].vertex;
        const glm::dvec3 &a = surface.vertices[corners[0]], &b = surface.vertices[corners[1]],
                         &c = surface.vertices[corners[2]];
        const glm::dvec3 minimum = glm::min(a, glm::min(b, c)), maximum = glm::max(a, glm::max(b, c));
        boxes_.push_back({glm::vec3(0.5 * (minimum + maximum)), widened(0.5 * (maximum - minimum)), f});
    }
    nodes_.reserve(surface.faces.size());
    if (!boxes_.empty()) build(0, static_cast<uint32_t>(boxes_.size()));
}

void SweptTree::build(uint32_t begin, uint32_t end)
{
    glm::dvec3 minimum(HUGE_VAL), maximum(-HUGE_VAL), low(HUGE_VAL), high(-HUGE_VAL);
    for (uint32_t i = begin; i < end; ++i) {
        const glm::dvec3 centre = boxes_[i].centre, half = boxes_[i].half;
        minimum = glm::min(minimum, centre - half), maximum = glm::max(maximum, centre + half);
        low = glm::min(low, centre), high = glm::max(high, centre);
    }
    const uint32_t index = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({glm::vec3(0.5 * (minimum + maximum)), widened(0.5 * (maximum - minimum)), begin, end});
    if (end - begin <= leaf_size) { // in an order of their own, not the library's
        std::sort(boxes_.begin() + begin, boxes_.begin() + end,
                  [](const Box& a, const Box& b) { return a.face < b.face; });
        return;
    }
    const glm::dvec3 spread = high - low;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(boxes_.begin() + begin, boxes_.begin() + middle, boxes_.begin() + end,
                     [axis](const Box& a, const Box& b) {
                         return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.face < b.face;
                     });
    build(begin, middle);
    nodes_[index].second = static_cast<uint32_t>(nodes_.size());
    build(middle, end);
}

} // namespace haptel::runtime
