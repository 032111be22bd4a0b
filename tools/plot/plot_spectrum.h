// How much of a texture lies at which wavelength.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace haptel::tools::plot {

// In place, forward, unscaled: X_k = sum x_n exp(-2 pi i k n / N). N is a power of two.
void fourier_transform(std::span<std::complex<double>> values);

struct Spectrum {
    std::vector<double> frequency_per_m; // 1 / length, 2 / length, ... up to half the sampling rate, ends not included
    std::vector<double> amplitude_m;     // zero to peak: a sine of amplitude A in the window shows a peak of A
};

// Root mean square over several lines of equal length, each sampled at equal distances over `length_m`; mean removed,
// Hann window. The number of samples in a line is a power of two.
Spectrum spectrum_of(const std::vector<std::vector<double>>& lines_m, double length_m);

} // namespace haptel::tools::plot
