// A viscous medium, felt as a point that trails behind the hand on a spring.
//
// The trailing point is drawn to the hand at the speed that the medium of damping b lets it have under the spring's
// force: at a steady speed v the force is b v. It moves only toward the hand, so each of its moves takes energy; what
// the hand can get back is what the spring of `trail_stiffness_n_per_m` holds. So whatever b is, and wherever it
// changes, the medium is as easy to keep stable as that spring: passive on a device whose own damping exceeds
// (n + 1/2) k T with n samples of delay. A damper made of the hand's speed alone would ask for more than b.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace haptel::runtime {

// Half that of an object by default. The force lags behind changes of speed by b / k.
inline constexpr double trail_stiffness_n_per_m = 400;

class Trail {
public:
    Trail(double period_s, double stiffness_n_per_m) noexcept;

    // Once per tick: where the hand is, the damping there, the periods since the call before. The force on the hand.
    glm::dvec3 update(const glm::dvec3& hand_m, double damping_n_s_per_m, uint64_t periods) noexcept;
    // Where the hand was is not known any more: the point starts from where it comes back.
    void lose_hand() noexcept { has_last_ = false, behind_m_ = glm::dvec3(0); }

private:
    double period_s_, stiffness_n_per_m_;
    bool has_last_ = false;
    glm::dvec3 last_m_{0}, behind_m_{0}; // from the trailing point to the hand
};

} // namespace haptel::runtime
