#include "runtime/servo/overload.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

OverloadPolicy::OverloadPolicy(double rate_hz) noexcept
    : window_periods_(static_cast<uint64_t>(std::max(least_periods, std::round(window_s * rate_hz))))
{
}

void OverloadPolicy::tick(uint64_t missed) noexcept
{
    periods_ += 1 + missed;
    missed_ += missed;
    if (periods_ >= window_periods_) end_window();
}

void OverloadPolicy::end_window() noexcept
{
    const double share = static_cast<double>(missed_) / static_cast<double>(periods_);
    periods_ = missed_ = 0;
    bad_ = share >= bad_share ? bad_ + 1 : 0;
    good_ = share <= good_share ? good_ + 1 : 0;
    hopeless_ = step_ == Degradation::no_textures && share >= hopeless_share ? hopeless_ + 1 : 0;
    if (hopeless_ == hopeless_windows) {
        step_ = Degradation::no_force; // for good: the run is about to end
    } else if (bad_ == bad_windows && step_ < Degradation::no_textures) {
        step_ = static_cast<Degradation>(static_cast<uint8_t>(step_) + 1);
        bad_ = 0;
    } else if (good_ == good_windows && step_ > Degradation::none && step_ < Degradation::no_force) {
        step_ = static_cast<Degradation>(static_cast<uint8_t>(step_) - 1);
        good_ = 0;
    }
}

} // namespace haptel::runtime
