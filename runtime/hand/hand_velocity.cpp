#include "runtime/hand/hand_velocity.h"

#include "runtime/geometry/finite.h"
#include "runtime/geometry/integer_power.h"

#include <algorithm>

namespace haptel::runtime {

namespace {

// 1 - exp(-x), the step response of a low-pass after x of its time constants. By doublings, x to 2 x, from where the
// first terms of the series are exact to rounding: the same bits whatever the C library.
double one_minus_exp(double x)
{
    x = std::min(x, 64.0); // all of it
    int doublings = 0;
    for (; x > 0x1p-10; x *= 0.5) ++doublings;
    double share = x * (1 - x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5))));
    for (; doublings > 0; --doublings) share *= 2 - share;
    return share;
}

} // namespace

HandVelocity::HandVelocity(double period_s) noexcept
    : period_s_(period_s), gain_(one_minus_exp(2 * 3.14159265358979323846 * velocity_cutoff_hz * period_s))
{
}

void HandVelocity::update(const glm::dvec3& hand_m, uint64_t periods) noexcept
{
    // Several periods: the low-pass as if each of them had seen the mean speed.
    const double count = static_cast<double>(periods);
    const double gain = periods == 1 ? gain_ : 1 - integer_power(1 - gain_, periods);
    if (has_last_) m_per_s_ += gain * ((hand_m - last_m_) / (count * period_s_) - m_per_s_);
    // Speeds may overflow where positions do not, and what is not finite would never leave a low-pass again.
    if (!has_last_ || !finite(m_per_s_)) m_per_s_ = glm::dvec3(0);
    last_m_ = hand_m;
    has_last_ = true;
}

} // namespace haptel::runtime
