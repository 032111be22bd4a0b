#include "tools/sound/high_pass.h"

#include <cmath>
#include <numbers>

namespace haptel::tools::sound {

HighPass::HighPass(double cutoff_hz, double rate_hz)
{
    if (cutoff_hz == 0) return;
    const double k = std::tan(std::numbers::pi * cutoff_hz / rate_hz);
    const double norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
    b0_ = norm;
    b1_ = -2 * norm;
    b2_ = norm;
    a1_ = 2 * (k * k - 1) * norm;
    a2_ = (1 - std::numbers::sqrt2 * k + k * k) * norm;
}

// Transposed direct form II: the one that loses least to rounding.
double HighPass::operator()(double sample)
{
    const double out = b0_ * sample + s1_;
    s1_ = b1_ * sample - a1_ * out + s2_;
    s2_ = b2_ * sample - a2_ * out;
    return out;
}

} // namespace haptel::tools::sound
