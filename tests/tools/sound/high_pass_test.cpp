// The high-pass against its closed form: a Butterworth's gain is 1 / sqrt(1 + (wc / w)^4), with w the tangent of half
// the angle per sample, which is what the bilinear transform does to a frequency.
#include "tests/support/catch.h"
#include "tools/sound/high_pass.h"

#include <cmath>
#include <numbers>

using haptel::tools::sound::HighPass;

namespace {

constexpr double rate_hz = 48'000;

// Amplitude of a sine that has passed, by its two quadratures over whole seconds.
double passed(double cutoff_hz, double frequency_hz)
{
    HighPass filter(cutoff_hz, rate_hz);
    double in_phase = 0, across = 0;
    for (int i = 0; i < 4 * 48'000; ++i) {
        const double turn = 2 * std::numbers::pi * frequency_hz * i / rate_hz;
        const double out = filter(std::sin(turn));
        if (i < 2 * 48'000) continue; // what the start has stirred up has died away
        in_phase += out * std::sin(turn), across += out * std::cos(turn);
    }
    return std::hypot(in_phase, across) / 48'000;
}

double tangent(double frequency_hz)
{
    return std::tan(std::numbers::pi * frequency_hz / rate_hz);
}

} // namespace

TEST_CASE("a high-pass has the gain of a Butterworth of second order")
{
    for (const double cutoff_hz : {20.0, 100.0, 5'000.0})
        for (const double frequency_hz : {5.0, 20.0, 100.0, 1'000.0, 20'000.0}) {
            CAPTURE(cutoff_hz, frequency_hz);
            const double expected = 1 / std::sqrt(1 + std::pow(tangent(cutoff_hz) / tangent(frequency_hz), 4));
            CHECK(std::abs(passed(cutoff_hz, frequency_hz) - expected) < 1e-6);
        }
}

TEST_CASE("a constant dies away in a high-pass, and goes through one that is off bit for bit")
{
    HighPass filter(20, rate_hz);
    double out = 0;
    for (int i = 0; i < 48'000; ++i) out = filter(3.0);
    CHECK(std::abs(out) < 1e-12);
    HighPass off(0, rate_hz);
    for (const double sample : {3.0, -0.1, 1e-300, 7e200}) CHECK(off(sample) == sample);
}
