#include "tests/support/catch.h"
#include "tools/plot/plot_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace haptel::tools::plot;

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

std::vector<double> sampled(std::size_t count, double length_m, double (*height)(double))
{
    std::vector<double> line;
    for (std::size_t i = 0; i < count; ++i)
        line.push_back(height(length_m * static_cast<double>(i) / static_cast<double>(count)));
    return line;
}

} // namespace

TEST_CASE("the fast transform is the sum that defines the slow one")
{
    for (const std::size_t n : {1, 2, 4, 16, 64}) {
        std::vector<std::complex<double>> values;
        for (std::size_t i = 0; i < n; ++i) {
            const auto x = static_cast<double>(i);
            values.emplace_back(std::sin(3 * x * x) + 1, std::cos(5 * x));
        }
        std::vector<std::complex<double>> expected(n);
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t i = 0; i < n; ++i)
                expected[k] +=
                    values[i] * std::polar(1.0, -two_pi * static_cast<double>(i * k % n) / static_cast<double>(n));
        fourier_transform(values);
        for (std::size_t k = 0; k < n; ++k) CHECK(std::abs(values[k] - expected[k]) < 1e-12 * static_cast<double>(n));
    }
}

TEST_CASE("a sine of 30 um and 2 mm shows as a peak of 30 um at 500 per metre, and nowhere else")
{
    constexpr double length_m = 0.02;
    const auto line =
        sampled(1024, length_m, [](double x) { return 5e-3 + 30e-6 * std::sin(two_pi * x / 2e-3 + 0.4); });
    const Spectrum spectrum = spectrum_of({line, line}, length_m);
    const auto peak = std::max_element(spectrum.amplitude_m.begin(), spectrum.amplitude_m.end());
    const auto index = static_cast<std::size_t>(peak - spectrum.amplitude_m.begin());
    CHECK(std::abs(spectrum.frequency_per_m[index] - 500) < 1e-9);
    CHECK(std::abs(*peak - 30e-6) < 1e-12); // Hann, a whole number of periods
    for (std::size_t k = 0; k < spectrum.amplitude_m.size(); ++k)
        if (k + 1 < index || k > index + 1) CHECK(spectrum.amplitude_m[k] < 1e-15); // its neighbours are the window's
    CHECK(std::abs(spectrum.amplitude_m[index + 1] - 15e-6) < 1e-12);
    CHECK(spectrum.frequency_per_m.front() == 1 / length_m);
    CHECK(spectrum.frequency_per_m.size() == 511);
}
