#include "runtime/hand_velocity.h"

#include "runtime/finite.h"

#include <cmath>

namespace haptel::runtime {

HandVelocity::HandVelocity(double period_s) noexcept
    : period_s_(period_s), gain_(1 - std::exp(-2 * 3.14159265358979323846 * velocity_cutoff_hz * period_s))
{
}

void HandVelocity::update(const glm::dvec3& hand_m, uint64_t periods) noexcept
{
    // One period: the same bits as ever. Several: the low-pass as if each of them had seen the mean speed.
    const double count = static_cast<double>(periods);
    const double gain = periods == 1 ? gain_ : 1 - std::pow(1 - gain_, count);
    if (has_last_) m_per_s_ += gain * ((hand_m - last_m_) / (count * period_s_) - m_per_s_);
    // Speeds may overflow where positions do not, and what is not finite would never leave a low-pass again.
    if (!has_last_ || !finite(m_per_s_)) m_per_s_ = glm::dvec3(0);
    last_m_ = hand_m;
    has_last_ = true;
}

} // namespace haptel::runtime
