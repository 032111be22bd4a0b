// How loud a force is, and what of it becomes full scale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptel::tools::sound {

class Level {
public:
    void add(std::span<const float> samples_n);

    double peak_n() const { return peak_n_; }
    double rms_n() const; // over all channels; 0 without any

private:
    double peak_n_ = 0, squares_ = 0;
    uint64_t count_ = 0;
};

// Which force is full scale so that the peak is 1 dB below it; 1 N where there is no force.
double full_scale_n(double peak_n);

// From newtons to shares of full scale. Returns how many samples were beyond it: they are cut off there.
uint64_t to_full_scale(std::span<float> samples, double full_scale_n);

} // namespace haptel::tools::sound
