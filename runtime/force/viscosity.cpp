#include "runtime/force/viscosity.h"

#include "runtime/geometry/finite.h"
#include "runtime/geometry/integer_power.h"

namespace haptel::runtime {

Trail::Trail(double period_s, double stiffness_n_per_m) noexcept
    : period_s_(period_s), stiffness_n_per_m_(stiffness_n_per_m)
{
}

glm::dvec3 Trail::update(const glm::dvec3& hand_m, double damping_n_s_per_m, uint64_t periods) noexcept
{
    const glm::dvec3 step_m = has_last_ ? hand_m - last_m_ : glm::dvec3(0);
    last_m_ = hand_m;
    has_last_ = true;
    // What is left of the way behind after one period: the implicit step of b d/dt(point) = k (hand - point).
    const double left = damping_n_s_per_m / (damping_n_s_per_m + stiffness_n_per_m_ * period_s_);
    if (periods == 1) {
        behind_m_ = left * (behind_m_ + step_m);
    } else { // several: the step spread over them evenly
        const double n = static_cast<double>(periods), all = integer_power(left, periods);
        behind_m_ = all * behind_m_ + left * (1 - all) / (1 - left) / n * step_m;
    }
    if (!finite(behind_m_)) behind_m_ = glm::dvec3(0); // ways may overflow where positions do not
    return -stiffness_n_per_m_ * behind_m_;
}

} // namespace haptel::runtime
