#include "runtime/surface/swept_region.h"

#include "runtime/surface/four_boxes.h"

#include <algorithm>

namespace haptel::runtime {

namespace {

// What rounding to single precision may make of a corner's place along an axis, and of where the region ends there. The
// object lies within 1, the corner off by 2^-22; the region within 7, its end off by 2^-22, its axis by 2^-24.
constexpr float rounding = 0x1p-20f;

// The sine of the angle between the shaft and an axis of space, squared, below which both have no right angle.
constexpr double least_across = 1e-6;

} // namespace

SweptRegion::SweptRegion(const glm::dvec3& tip0, const glm::dvec3& tail0, const glm::dvec3& tip1,
                         const glm::dvec3& tail1, double margin) noexcept
{
    const double wide = margin * BoxTree::scale + rounding;
    const glm::dvec3 ends[] = {tip0 * BoxTree::scale, tail0 * BoxTree::scale, tip1 * BoxTree::scale,
                               tail1 * BoxTree::scale};
    low_ = glm::min(glm::min(ends[0], ends[1]), glm::min(ends[2], ends[3])) - wide;
    high_ = glm::max(glm::max(ends[0], ends[1]), glm::max(ends[2], ends[3])) + wide;
    const glm::dvec3 shaft = ends[1] - ends[0];
    const double length = glm::length(shaft);
    if (length == 0) return;
    const auto add = [&](const glm::dvec3& across) {
        const double size = glm::length(across);
        if (!(size > 0)) return;
        const glm::dvec3 direction = across / size;
        const double at[] = {glm::dot(direction, ends[0]), glm::dot(direction, ends[1]), glm::dot(direction, ends[2]),
                             glm::dot(direction, ends[3])};
        const auto [least, most] = std::minmax({at[0], at[1], at[2], at[3]});
        axes_[axis_count_++] = {direction, static_cast<float>(least - wide), static_cast<float>(most + wide)};
    };
    const glm::dvec3 along = shaft / length;
    add(glm::cross(along, 0.5 * (ends[2] + ends[3] - ends[0] - ends[1])));
    for (int k = 0; k < 3; ++k) { // two of the three span what is across; each is the best against some boxes
        glm::dvec3 unit(0);
        unit[k] = 1;
        const glm::dvec3 across = glm::cross(along, unit);
        if (glm::dot(across, across) > least_across) add(across);
    }
    add(along);
}

bool SweptRegion::meets(const Surface& surface, uint32_t face) const noexcept
{
    const auto& corners = surface.faces[face].vertex;
    const glm::dvec3 a = BoxTree::scale * surface.vertices[corners[0]],
                     b = BoxTree::scale * surface.vertices[corners[1]],
                     c = BoxTree::scale * surface.vertices[corners[2]];
    for (uint32_t i = 0; i < axis_count_; ++i) {
        const auto& [direction, low, high] = axes_[i];
        const glm::dvec3 along(direction);
        const double at_a = glm::dot(along, a), at_b = glm::dot(along, b), at_c = glm::dot(along, c);
        if ((at_a > high && at_b > high && at_c > high) || (at_a < low && at_b < low && at_c < low)) return false;
    }
    return true;
}

uint32_t SweptRegion::met(const BoxTree::Node& node) const noexcept
{
    const auto in_box = [&](uint32_t first) {
        FourBits all = {-1, -1, -1, -1};
        for (int k = 0; k < 3; ++k)
            all &= (four(node.low[k] + first) <= all_of(high_[k])) & (four(node.high[k] + first) >= all_of(low_[k]));
        return all;
    };
    const auto along_axes = [&](uint32_t first, FourBits all) {
        for (uint32_t i = 0; i < axis_count_; ++i) {
            const auto& [direction, low, high] = axes_[i];
            Four least_there = all_of(0), most_there = all_of(0);
            for (int k = 0; k < 3; ++k) {
                const bool backward = direction[k] < 0;
                least_there += all_of(direction[k]) * four((backward ? node.high : node.low)[k] + first);
                most_there += all_of(direction[k]) * four((backward ? node.low : node.high)[k] + first);
            }
            all &= (least_there <= all_of(high)) & (most_there >= all_of(low));
        }
        return all;
    };
    const FourBits first = in_box(0), second = in_box(half);
    if (bits(first, second) == 0) return 0;
    return bits(along_axes(0, first), along_axes(half, second));
}

} // namespace haptel::runtime
