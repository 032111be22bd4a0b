#include "tools/plot/plot_spectrum.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace haptel::tools::plot {

void fourier_transform(std::span<std::complex<double>> values)
{
    const std::size_t n = values.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) { // into bit-reversed order
        std::size_t bit = n >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i], values[j]);
    }
    for (std::size_t length = 2; length <= n; length *= 2)
        for (std::size_t k = 0; k < length / 2; ++k) {
            const auto turn =
                std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length));
            for (std::size_t start = k; start < n; start += length) {
                const std::complex<double> even = values[start], odd = turn * values[start + length / 2];
                values[start] = even + odd;
                values[start + length / 2] = even - odd;
            }
        }
}

Spectrum spectrum_of(const std::vector<std::vector<double>>& lines_m, double length_m)
{
    const std::size_t n = lines_m.front().size();
    std::vector<double> power(n / 2);
    for (const std::vector<double>& line : lines_m) {
        double mean = 0;
        for (const double height : line) mean += height / static_cast<double>(n);
        std::vector<std::complex<double>> values(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double hann =
                1 - std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n)); // mean 1
            values[i] = hann * (line[i] - mean);
        }
        fourier_transform(values);
        for (std::size_t k = 1; k < n / 2; ++k) power[k] += std::norm(values[k]) / static_cast<double>(lines_m.size());
    }
    Spectrum spectrum;
    for (std::size_t k = 1; k < n / 2; ++k) {
        spectrum.frequency_per_m.push_back(static_cast<double>(k) / length_m);
        spectrum.amplitude_m.push_back(2 * std::sqrt(power[k]) / static_cast<double>(n));
    }
    return spectrum;
}

} // namespace haptel::tools::plot
