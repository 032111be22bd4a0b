// How fast the hand moves, from where it is: the backward difference of its positions, over the periods that really
// passed between them, through a one-pole low-pass.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace haptel::runtime {

inline constexpr double velocity_cutoff_hz = 100;

class HandVelocity {
public:
    explicit HandVelocity(double period_s) noexcept;

    void update(const glm::dvec3& hand_m, uint64_t periods) noexcept;
    // Where the hand was is not known any more: it is taken to rest when it comes back.
    void lose_hand() noexcept { has_last_ = false; }
    bool has_hand() const noexcept { return has_last_; }

    const glm::dvec3& m_per_s() const noexcept { return m_per_s_; }

private:
    double period_s_;
    double gain_; // of the low-pass
    bool has_last_ = false;
    glm::dvec3 last_m_{0};
    glm::dvec3 m_per_s_{0};
};

} // namespace haptel::runtime
