// What a servo leaves out when its ticks take longer than its periods, in steps, before the hand is hurt.
//
// The run is cut into windows of `window_s`, and of ten periods at least. `bad_windows` in a row in which a share of
// the deadlines of at least `bad_share` was missed lead one step on; `good_windows` in a row with at most `good_share`
// lead one step back. What lies between changes nothing, so that it does not go to and fro. The last step takes the
// force away: only where the hand feels nothing but bare surfaces and `hopeless_windows` in a row missed at least
// `hopeless_share`. A tick that is late once, by however much, is one window, and leads nowhere.
//
// A function of the deadlines that were missed alone: on the virtual clock none is, and nothing is left out.
#pragma once

#include "runtime/hand/degradation.h"

#include <cstdint>

namespace haptel::runtime {

class OverloadPolicy {
public:
    static constexpr double window_s = 0.1, least_periods = 10;
    static constexpr double bad_share = 0.2, good_share = 0.02, hopeless_share = 0.5;
    static constexpr uint32_t bad_windows = 3, good_windows = 10, hopeless_windows = 10;

    explicit OverloadPolicy(double rate_hz) noexcept;

    // After each tick: so many deadlines were missed since the one before.
    void tick(uint64_t missed) noexcept;
    Degradation step() const noexcept { return step_; }

private:
    void end_window() noexcept;

    uint64_t window_periods_;
    uint64_t periods_ = 0, missed_ = 0;          // of this window
    uint32_t bad_ = 0, good_ = 0, hopeless_ = 0; // windows in a row
    Degradation step_ = Degradation::none;
};

} // namespace haptel::runtime
