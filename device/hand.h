// The hand that holds a simulated device: a mass, a damper and a spring towards where it means to be, and a push.
//
// Voluntary motion is slow: aim, push and grip pass a first-order low-pass at 20 Hz, and the aim never moves faster
// than a fast stroke, so that a jump of the surface below the stroke is no jump of the hand.
#pragma once

#include "device/stroke.h"

namespace haptel::device {

inline constexpr double hand_bandwidth_hz = 20;
inline constexpr double hand_speed_max_m_per_s = 0.5;

// Lumped impedance of hand and grip (literature spreads widely: see presets.h).
struct HandImpedance {
    double mass_kg = 0; // moves rigidly with the device
    double damping_n_s_per_m = 0;
    double stiffness_n_per_m = 0;
};

// Advances in whole periods, like the device that it holds. Allocates nothing.
class Hand {
public:
    Hand(const HandImpedance& impedance, Stroke stroke, double press_n, double period_s);

    const HandImpedance& impedance() const { return impedance_; }

    // Looks one period ahead: aim and push now move from where they were to where they shall be.
    void advance();

    // Aim and push at a share (0 .. 1) of the current period.
    glm::dvec3 aim_m(double share) const { return glm::mix(aim_from_m_, aim_to_m_, share); }
    glm::dvec3 push_n(double share) const { return glm::mix(push_from_n_, push_to_n_, share); }
    // How hard it closes a gripper instead, and how much of its stiffness holds that open, 0 .. 1.
    double squeeze_n(double share) const { return press_n_ * (1 - opened(share)); }
    double opened(double share) const { return glm::mix(opened_from_, opened_to_, share); }
    glm::dvec3 aim_velocity_m_per_s() const { return (aim_to_m_ - aim_from_m_) / period_s_; }

private:
    HandImpedance impedance_;
    Stroke stroke_;
    double press_n_, period_s_;
    uint64_t periods_ = 0;
    glm::dvec3 aim_from_m_, aim_to_m_;
    glm::dvec3 push_from_n_{0}, push_to_n_{0};
    double opened_from_ = 1, opened_to_ = 1;
};

} // namespace haptel::device
