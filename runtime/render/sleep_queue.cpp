#include "runtime/render/sleep_queue.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

// A way counts in these, rounded up, and a gap rounded down: a picometre, finer than any hand, is 1e7 m on half of the
// circle. What is larger than a quarter of that counts as such, and wakes everybody.
constexpr double units_per_m = 0x1p40;
constexpr uint64_t units_most = uint64_t{1} << 61;

uint64_t units(double m)
{
    const double all = m * units_per_m;
    return all < static_cast<double>(units_most) ? static_cast<uint64_t>(all) : units_most;
}

// Coordinates are rounded, and of what turns a part of the gap is left over: nobody sleeps too long.
constexpr double early = 1 - 1e-6, early_if_turning = 1 - 2 * turn_max_rad;

// The ball around two is rounded up.
constexpr double sphere_rounding = 1e-12;

// A metre before the circle is round, which so happens in every run and not after 1e7 m first.
constexpr uint64_t way_at_start = uint64_t{0} - (uint64_t{1} << 40);

BoundingSphere around_both(const BoundingSphere& a, const BoundingSphere& b)
{
    const bool turns = a.turns || b.turns;
    const glm::dvec3 way = b.centre_m - a.centre_m;
    const double apart = glm::length(way);
    if (apart + b.radius_m <= a.radius_m) return {a.centre_m, a.radius_m, turns};
    if (apart + a.radius_m <= b.radius_m) return {b.centre_m, b.radius_m, turns};
    const double radius = (apart + a.radius_m + b.radius_m) / 2;
    const glm::dvec3 centre = a.centre_m + (radius - a.radius_m) / apart * way;
    const glm::dvec3 farthest = glm::max(glm::abs(a.centre_m), glm::abs(b.centre_m));
    return {centre, radius + sphere_rounding * (radius + farthest.x + farthest.y + farthest.z), turns};
}

} // namespace

SleepQueue::SleepQueue(std::vector<BoundingSphere> objects, bool leaves_alone)
    : object_count_(objects.size())
    , spheres_(std::move(objects))
    , nodes_(object_count_, Node{.at = way_at_start})
    , way_(way_at_start)
{
    awake_.reserve(object_count_);
    if (!leaves_alone) {
        for (uint32_t object = 0; object < object_count_; ++object) awake_.push_back(object);
        return;
    }
    std::array<std::vector<uint32_t>, kinds> objects_of;
    for (uint32_t object = 0; object < object_count_; ++object) {
        const BoundingSphere& around = spheres_[object];
        objects_of[!std::isfinite(around.radius_m) ? anywhere : around.turns ? turning : at_rest].push_back(object);
    }
    for (uint32_t kind = 0; kind < kinds; ++kind)
        if (!objects_of[kind].empty()) root_[kind] = group(objects_of[kind]);
    if (root_[anywhere] != none) wake_all(root_[anywhere]);
    std::sort(awake_.begin(), awake_.end());
}

// Halves along the axis on which the objects are farthest apart.
uint32_t SleepQueue::group(std::span<uint32_t> objects)
{
    if (objects.size() == 1) return objects[0];
    glm::dvec3 least(spheres_[objects[0]].centre_m), most = least;
    for (const uint32_t object : objects) {
        least = glm::min(least, spheres_[object].centre_m);
        most = glm::max(most, spheres_[object].centre_m);
    }
    const glm::dvec3 sides = most - least;
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const std::size_t half = objects.size() / 2;
    std::nth_element(objects.begin(), objects.begin() + static_cast<std::ptrdiff_t>(half), objects.end(),
                     [&](uint32_t a, uint32_t b) {
                         const double place_a = spheres_[a].centre_m[axis], place_b = spheres_[b].centre_m[axis];
                         return place_a != place_b ? place_a < place_b : a < b;
                     });
    const uint32_t first = group(objects.first(half)), second = group(objects.subspan(half));
    const auto both = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({.at = way_, .first = first, .second = second});
    nodes_[first].parent = nodes_[second].parent = both;
    spheres_.push_back(around_both(spheres_[first], spheres_[second]));
    return both;
}

double gap_m(const BoundingSphere& around, const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    const glm::dvec3 shaft = tail_m - tip_m, to_centre = around.centre_m - tip_m;
    const double square = glm::dot(shaft, shaft);
    const double share = square > 0 ? glm::clamp(glm::dot(to_centre, shaft) / square, 0.0, 1.0) : 0.0;
    return glm::length(to_centre - share * shaft) - around.radius_m;
}

double far_enough_m(const glm::dvec3& tip_m, const glm::dvec3& tail_m, double way_m) noexcept
{
    const glm::dvec3 farthest = glm::max(glm::abs(tip_m), glm::abs(tail_m));
    return std::max({1e-6, 8 * way_m, 1e-6 * std::max({farthest.x, farthest.y, farthest.z})});
}

// On the circle, of which all that sleep are on the half that lies ahead.
void SleepQueue::go(double way_m, const glm::dvec3& tip_m, const glm::dvec3& tail_m, double near_m) noexcept
{
    const uint64_t way = units(way_m);
    if (way < units_most) {
        way_ += way + (way_m > 0);
    } else { // or is no number
        for (Node& node : nodes_) node.at = way_;
    }
    for (const uint32_t root : root_)
        if (root != none && is_due(nodes_[root].at)) look_at(root, false, {tip_m, tail_m, near_m});
}

// Anew: it slept in its group, and what is known of it is older than that.
void SleepQueue::look_at(uint32_t number, bool anew, const Probe& probe) noexcept
{
    Node& node = nodes_[number];
    if (node.awake == 0 && (anew || !node.parted || is_due(node.far_from))) {
        ++compared_;
        const double gap = runtime::gap_m(spheres_[number], probe.tip_m, probe.tail_m);
        if (gap > probe.near_m) return sleep_for(number, gap);
        node.far_from = way_ + units(probe.near_m - gap);
    }
    if (!is_group(number)) return wake(number);
    anew = anew || !std::exchange(node.parted, true);
    for (const uint32_t half : {node.first, node.second})
        if (anew || is_due(nodes_[half].at)) look_at(half, anew, probe);
    sum_up(number);
}

void SleepQueue::wake_who_turns() noexcept
{
    const std::size_t before = awake_.size();
    if (root_[turning] != none) wake_all(root_[turning]);
    if (awake_.size() > before) std::sort(awake_.begin(), awake_.end());
}

void SleepQueue::sleep(uint32_t object, double gap_m) noexcept
{
    awake_.erase(std::lower_bound(awake_.begin(), awake_.end(), object));
    nodes_[object].awake = 0;
    sleep_for(object, gap_m);
    for (uint32_t group = nodes_[object].parent; group != none; group = nodes_[group].parent) sum_up(group);
}

void SleepQueue::sleep_for(uint32_t node, double gap_m) noexcept
{
    nodes_[node].at = way_ + units((spheres_[node].turns ? early_if_turning : early) * gap_m);
    nodes_[node].parted = false;
}

// Room for all was made. Who is awake is asked for again after the longest way there is, and stays so.
void SleepQueue::wake(uint32_t object) noexcept
{
    nodes_[object].at = way_ + units_most;
    if (std::exchange(nodes_[object].awake, 1) == 0)
        awake_.insert(std::lower_bound(awake_.begin(), awake_.end(), object), object);
}

// In no order.
void SleepQueue::wake_all(uint32_t number) noexcept
{
    Node& node = nodes_[number];
    if (number < object_count_) {
        node.at = way_ + units_most;
        if (std::exchange(node.awake, 1) == 0) awake_.push_back(number);
        return;
    }
    node.parted = true;
    for (const uint32_t half : {node.first, node.second}) wake_all(half);
    sum_up(number);
}

void SleepQueue::sum_up(uint32_t number) noexcept
{
    Node& group = nodes_[number];
    const Node &first = nodes_[group.first], &second = nodes_[group.second];
    group.at = static_cast<int64_t>(first.at - second.at) < 0 ? first.at : second.at;
    group.awake = first.awake + second.awake;
}

} // namespace haptel::runtime
