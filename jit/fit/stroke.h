// A recorded stroke over a surface, to and fro: what a hand felt or an accelerometer measured, at one speed.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace haptel::jit {

struct Stroke {
    enum class Of : unsigned char {
        force,        // along the normal, newtons: stiffness times height
        acceleration, // along the normal, m/s^2, of a tip that follows the surface
    };
    Of of = Of::force;
    double rate_hz = 1000, speed_m_per_s = 0.1;
    double stiffness_n_per_m = 0;            // of a force
    double direction[2] = {1, 0};            // of the hand over the surface, by x and y; of length 1
    std::vector<std::vector<double>> passes; // without the hand's turns, where its speed is another

    std::size_t samples() const
    {
        std::size_t sum = 0;
        for (const std::vector<double>& pass : passes) sum += pass.size();
        return sum;
    }
    double pass_m() const { return step_m() * static_cast<double>(samples()) / static_cast<double>(passes.size()); }
    // Side of the object, upright, in which a square of passes lies.
    double box_m() const { return pass_m() * (std::abs(direction[0]) + std::abs(direction[1])); }
    double step_m() const { return speed_m_per_s / rate_hz; }
    // Power of heights over that of the values, at so many cycles per metre.
    double power_of_height(double cycles_per_m) const;
};

// What a hand feels of a vibration.
inline constexpr double felt_from_hz = 20, felt_to_hz = 1000;

} // namespace haptel::jit
