#include "runtime/hand/hand_history.h"

#include "runtime/hand/hand_velocity.h"

#include <cmath>

namespace haptel::runtime {

namespace {

constexpr double time_constants = 16; // of the low-pass; exp(-16) is 1e-7

} // namespace

HandHistory::HandHistory(double period_s) noexcept
{
    const double needed = time_constants / (2 * 3.14159265358979323846 * velocity_cutoff_hz * period_s);
    apart_ = static_cast<uint64_t>(std::ceil(needed / static_cast<double>(entries_.size())));
}

void HandHistory::add(uint64_t period, const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    now_ = {period, count_ > 0 ? period - newest().period : 1, tip_m, tail_m};
    if (count_ == 0 || now_.periods >= apart_) entries_[count_++ % entries_.size()] = now_;
}

} // namespace haptel::runtime
