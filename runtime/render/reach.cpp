#include "runtime/render/reach.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace haptel::runtime {

namespace {

// The way is rounded up, the gap down, and of what turns a part of the gap is left over: nobody sleeps too long.
constexpr double up = 1 + 0x1p-51, early = 1 - 1e-6, early_if_turning = 0.9;
static_assert(early_if_turning + turn_max_rad < 1);
// The way is counted anew before it has lost the digits of a step.
constexpr double way_max_m = 100;

} // namespace

Reach::Reach(std::vector<Surroundings> objects) : objects_(std::move(objects))
{
    sleepers_.reserve(objects_.size());
    for (uint32_t object = 0; object < objects_.size(); ++object) awake_.push_back(object);
}

double gap_m(const Surroundings& around, const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    const glm::dvec3 shaft = tail_m - tip_m, to_centre = around.centre_m - tip_m;
    const double square = glm::dot(shaft, shaft);
    const double share = square > 0 ? glm::clamp(glm::dot(to_centre, shaft) / square, 0.0, 1.0) : 0.0;
    return glm::length(to_centre - share * shaft) - around.radius_m;
}

void Reach::go(double way_m, const glm::dvec3& tip_m, const glm::dvec3& tail_m, double near_m) noexcept
{
    way_m_ = (way_m_ + way_m) * up;
    if (!(way_m_ < way_max_m)) wake_all();
    while (!sleepers_.empty() && sleepers_.front().first <= way_m_) {
        const uint32_t object = sleepers_.front().second;
        std::pop_heap(sleepers_.begin(), sleepers_.end(), std::greater<>());
        sleepers_.pop_back();
        const double gap = runtime::gap_m(objects_[object], tip_m, tail_m);
        if (gap > near_m) {
            fall_asleep(object, gap);
            continue;
        }
        awake_.insert(std::lower_bound(awake_.begin(), awake_.end(), object), object); // room for all was made
    }
}

void Reach::sleep(uint32_t object, double gap_m) noexcept
{
    awake_.erase(std::lower_bound(awake_.begin(), awake_.end(), object));
    fall_asleep(object, gap_m);
}

void Reach::fall_asleep(uint32_t object, double gap_m) noexcept
{
    sleepers_.emplace_back(way_m_ + (objects_[object].turns ? early_if_turning : early) * gap_m, object);
    std::push_heap(sleepers_.begin(), sleepers_.end(), std::greater<>());
}

void Reach::wake_all() noexcept
{
    for (const Sleeper& sleeper : sleepers_) awake_.push_back(sleeper.second);
    std::sort(awake_.begin(), awake_.end());
    sleepers_.clear();
    way_m_ = 0;
}

} // namespace haptel::runtime
