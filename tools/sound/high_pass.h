// What a voice coil cannot render, and would heat it: the constant part of a force, and what changes slowly.
#pragma once

namespace haptel::tools::sound {

// Butterworth of second order: at `cutoff_hz` 3 dB down, below that 12 dB more per octave. By the bilinear transform,
// exact at the cutoff.
class HighPass {
public:
    // cutoff_hz = 0: everything passes, bit for bit. Else below half of rate_hz.
    HighPass(double cutoff_hz, double rate_hz);

    double operator()(double sample);

private:
    double b0_ = 1, b1_ = 0, b2_ = 0, a1_ = 0, a2_ = 0;
    double s1_ = 0, s2_ = 0;
};

} // namespace haptel::tools::sound
