#include "runtime/surface/swept_region.h"

#include "runtime/surface/four_boxes.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// What rounding to single precision may make of a box's place along an axis, and of where the region ends there. The
// object lies within 1, so that the place is off by 9 * 2^-24; the region within 7, its end off by 4, its axis by 2.
constexpr float rounding = 0x1p-20f;

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
    const auto add = [&](const glm::dvec3& across, double square) { // of its length
        const glm::dvec3 direction = across * (1 / std::sqrt(square));
        const double at[] = {glm::dot(direction, ends[0]), glm::dot(direction, ends[1]), glm::dot(direction, ends[2]),
                             glm::dot(direction, ends[3])};
        axes_[axis_count_++] = {direction,
                                static_cast<float>(std::min(std::min(at[0], at[1]), std::min(at[2], at[3])) - wide),
                                static_cast<float>(std::max(std::max(at[0], at[1]), std::max(at[2], at[3])) + wide)};
    };
    const glm::dvec3 along = shaft / length;
    const glm::dvec3 turned = glm::cross(along, 0.5 * (ends[2] + ends[3] - ends[0] - ends[1]));
    if (const double square = glm::dot(turned, turned); square > 0) add(turned, square);
    // Two across the shaft: at right angles to the axes of space along which it lies least.
    const glm::dvec3 size = glm::abs(along);
    const int most = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const glm::dvec3 across[] = {{0, along.z, -along.y}, {-along.z, 0, along.x}, {along.y, -along.x, 0}};
    for (int k = 0; k < 3; ++k)
        if (k != most) add(across[k], 1 - along[k] * along[k]);
}

bool SweptRegion::meets(const Surface& surface, uint32_t face) const noexcept
{
    const auto [a, b, c] = surface.corners(face);
    for (uint32_t i = 0; i < axis_count_; ++i) {
        const auto& [direction, low, high] = axes_[i];
        const glm::dvec3 along = BoxTree::scale * glm::dvec3(direction);
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
    // Of a box by its centre and half its size.
    const auto along_axes = [&](uint32_t first, FourBits all) {
        Four centre[3], half_size[3];
        for (int k = 0; k < 3; ++k) {
            const Four low = four(node.low[k] + first), high = four(node.high[k] + first);
            centre[k] = 0.5f * (low + high);
            half_size[k] = 0.5f * (high - low);
        }
        for (uint32_t i = 0; i < axis_count_; ++i) {
            const auto& [direction, low, high] = axes_[i];
            const glm::vec3 size = glm::abs(direction);
            const Four at = direction.x * centre[0] + direction.y * centre[1] + direction.z * centre[2];
            const Four reach = size.x * half_size[0] + size.y * half_size[1] + size.z * half_size[2];
            all &= (at - reach <= all_of(high)) & (at + reach >= all_of(low));
        }
        return all;
    };
    FourBits first = in_box(0), second = in_box(half);
    if (bits(first, FourBits{}) != 0) first = along_axes(0, first);
    if (bits(FourBits{}, second) != 0) second = along_axes(half, second);
    return bits(first, second);
}

} // namespace haptel::runtime
