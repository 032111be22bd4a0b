#include "runtime/render/sleep_queue.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

// A way counts in these, rounded up, and a gap rounded down: a picometre, finer than any hand, is 1e7 m on half of the
// circle. What is larger than a quarter of that counts as such, and wakes everybody.
constexpr double units_per_m = 0x1p40, units_most = 0x1p61;

// Coordinates are rounded, and of what turns a part of the gap is left over: nobody sleeps too long.
constexpr double early = 1 - 1e-6, early_if_turning = 0.9;
static_assert(early_if_turning + turn_max_rad < 1);

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
    : object_count_(objects.size()), spheres_(std::move(objects)), way_(way_at_start)
{
    // Who turns is apart, since it has to be awake apart (wake_who_turns).
    std::vector<uint32_t> at_rest, turning;
    awake_.reserve(object_count_);
    for (uint32_t object = 0; object < object_count_; ++object)
        if (!leaves_alone || !std::isfinite(spheres_[object].radius_m))
            awake_.push_back(object);
        else
            (spheres_[object].turns ? turning : at_rest).push_back(object);
    sleepers_.reserve(object_count_);
    for (std::vector<uint32_t>* some : {&at_rest, &turning})
        if (!some->empty()) sleepers_.push_back({way_, group(*some)});
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
    groups_.push_back({first, second});
    spheres_.push_back(around_both(spheres_[first], spheres_[second]));
    return static_cast<uint32_t>(spheres_.size() - 1);
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

// On the circle, of which all sleepers are on the half that lies ahead.
bool SleepQueue::later(const Sleeper& a, const Sleeper& b) noexcept
{
    return static_cast<int64_t>(a.at - b.at) > 0;
}

void SleepQueue::go(double way_m, const glm::dvec3& tip_m, const glm::dvec3& tail_m, double near_m) noexcept
{
    const double units = std::ceil(way_m * units_per_m);
    if (units < units_most) {
        way_ += static_cast<uint64_t>(units);
    } else { // or is no number
        for (Sleeper& sleeper : sleepers_) sleeper.at = way_;
    }
    while (!sleepers_.empty() && static_cast<int64_t>(sleepers_.front().at - way_) <= 0) {
        const uint32_t node = sleepers_.front().node;
        std::pop_heap(sleepers_.begin(), sleepers_.end(), later);
        sleepers_.pop_back();
        ++compared_;
        const double gap = runtime::gap_m(spheres_[node], tip_m, tail_m);
        if (gap > near_m) {
            sleep_for(node, gap);
        } else if (is_group(node)) {
            for (const uint32_t half : {group_of(node).first, group_of(node).second}) fall_asleep(half, 0);
        } else {
            wake(node);
        }
    }
}

void SleepQueue::wake_who_turns() noexcept
{
    bool any = false;
    for (std::size_t i = 0; i < sleepers_.size();) {
        const uint32_t node = sleepers_[i].node;
        if (!spheres_[node].turns) {
            ++i;
            continue;
        }
        any = true;
        if (is_group(node)) {
            sleepers_[i].node = group_of(node).first;
            sleepers_.push_back({way_, group_of(node).second});
        } else {
            awake_.push_back(node);
            sleepers_[i] = sleepers_.back();
            sleepers_.pop_back();
        }
    }
    if (!any) return;
    std::sort(awake_.begin(), awake_.end());
    std::make_heap(sleepers_.begin(), sleepers_.end(), later);
}

void SleepQueue::sleep(uint32_t object, double gap_m) noexcept
{
    awake_.erase(std::lower_bound(awake_.begin(), awake_.end(), object));
    sleep_for(object, gap_m);
}

void SleepQueue::sleep_for(uint32_t node, double gap_m) noexcept
{
    const double units = (spheres_[node].turns ? early_if_turning : early) * gap_m * units_per_m;
    fall_asleep(node, units < units_most ? static_cast<uint64_t>(units) : static_cast<uint64_t>(units_most));
}

void SleepQueue::fall_asleep(uint32_t node, uint64_t units) noexcept
{
    sleepers_.push_back({way_ + units, node}); // room for all was made
    std::push_heap(sleepers_.begin(), sleepers_.end(), later);
}

void SleepQueue::wake(uint32_t object) noexcept
{
    awake_.insert(std::lower_bound(awake_.begin(), awake_.end(), object), object); // room for all was made
}

} // namespace haptel::runtime
