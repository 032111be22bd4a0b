#include "tools/sound/level.h"

#include <algorithm>
#include <cmath>

namespace haptel::tools::sound {

namespace {

constexpr double headroom_db = 1; // what players add when they convert rates
constexpr double silent_full_scale_n = 1;

} // namespace

void Level::add(std::span<const float> samples_n)
{
    for (const double sample_n : samples_n) {
        peak_n_ = std::max(peak_n_, std::abs(sample_n));
        squares_ += sample_n * sample_n;
    }
    count_ += samples_n.size();
}

double Level::rms_n() const
{
    return count_ == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(count_));
}

double full_scale_n(double peak_n)
{
    return peak_n > 0 ? peak_n * std::pow(10, headroom_db / 20) : silent_full_scale_n;
}

uint64_t to_full_scale(std::span<float> samples, double full_scale_n)
{
    uint64_t clipped = 0;
    for (float& sample : samples) {
        const double share = sample / full_scale_n;
        clipped += std::abs(share) > 1;
        sample = static_cast<float>(std::clamp(share, -1.0, 1.0));
    }
    return clipped;
}

} // namespace haptel::tools::sound
