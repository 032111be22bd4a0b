#include "runtime/reach.h"

#include <algorithm>
#include <functional>

namespace haptel::runtime {

namespace {

// The way is rounded up, the gap down: nobody sleeps too long.
constexpr double up = 1 + 0x1p-51, early = 1 - 1e-6;
// The way is counted anew before it has lost the digits of a step.
constexpr double way_max_m = 100;

} // namespace

Reach::Reach(std::size_t objects)
{
    sleepers_.reserve(objects);
    for (uint32_t object = 0; object < objects; ++object) awake_.push_back(object);
}

void Reach::go(double way_m) noexcept
{
    way_m_ = (way_m_ + way_m) * up;
    if (!(way_m_ < way_max_m)) wake_all();
    while (!sleepers_.empty() && sleepers_.front().first <= way_m_) {
        const uint32_t object = sleepers_.front().second;
        std::pop_heap(sleepers_.begin(), sleepers_.end(), std::greater<>());
        sleepers_.pop_back();
        awake_.insert(std::lower_bound(awake_.begin(), awake_.end(), object), object); // room for all was made
    }
}

void Reach::sleep(uint32_t object, double gap_m) noexcept
{
    awake_.erase(std::lower_bound(awake_.begin(), awake_.end(), object));
    sleepers_.emplace_back(way_m_ + early * gap_m, object);
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
