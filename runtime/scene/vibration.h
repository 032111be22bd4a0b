// A force that swings to and fro whatever the hand does: the one effect that is a source of energy. It gives a hand
// that moves with it at most its amplitude times the hand's speed.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptel::runtime {

// In which a vibration comes and goes, seconds: no step in force, and no click.
inline constexpr double vibration_ramp_s = 0.02;

// To and fro, from 0 and upward first, once in each turn.
inline double swing(double turns) noexcept
{
    return std::sin(2 * std::numbers::pi * std::remainder(turns, 1.0));
}

struct Vibration {
    double force_n = 0;            // >= 0, amplitude; 0: none
    double frequency_hz = 100;     // > 0, below half the servo's rate
    glm::dvec3 direction{0, 0, 1}; // unit

    bool acts() const { return force_n > 0; }

    // Without its direction. Of time alone, so that runs can be repeated bit for bit.
    double swing_n(double time_s) const noexcept { return force_n * swing(frequency_hz * time_s); }
};

// How much of a vibration is felt: follows what is wanted, 0 to 1, by a ramp.
class VibrationLevel {
public:
    double update(double wanted, double passed_s) noexcept
    {
        const double step = passed_s / vibration_ramp_s;
        return level_ += std::clamp(wanted - level_, -step, step);
    }
    bool sounds() const noexcept { return level_ > 0; }

private:
    double level_ = 0;
};

} // namespace haptel::runtime
