// Filtered white noise: its samples from the library's table, its splines as convolutions of a box, and its spectrum.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace haptel::test;

namespace {

double sample(int i, int j, int k)
{
    return 2 * shuffled(shuffled(shuffled(i) + j) + k) / 255.0 - 1;
}

// The quadratic B-spline: three unit boxes convolved.
double spline(double t)
{
    const auto plus = [](double x) { return x > 0 ? x * x / 2 : 0.0; };
    return plus(t + 1.5) - 3 * plus(t + 0.5) + 3 * plus(t - 0.5) - plus(t - 1.5);
}

double expected_white(const Vec3& q, bool in_space)
{
    double sum = 0;
    const int i0 = static_cast<int>(std::floor(q[0])), j0 = static_cast<int>(std::floor(q[1])),
              k0 = in_space ? static_cast<int>(std::floor(q[2])) : 0, deep = in_space ? 2 : 0;
    for (int i = i0 - 2; i <= i0 + 2; ++i)
        for (int j = j0 - 2; j <= j0 + 2; ++j)
            for (int k = k0 - deep; k <= k0 + deep; ++k)
                sum += sample(i, j, k) * spline(q[0] - i) * spline(q[1] - j) * (in_space ? spline(q[2] - k) : 1);
    return sum;
}

} // namespace

TEST_CASE("white_spline is white samples convolved with a spline")
{
    const Field solid("white_spline(q, 0)"), flat("white_spline(q.xy, 0)");
    for (const Vec3& q : points_within(40, 1000)) {
        CHECK(std::fabs(solid(q).value - expected_white(q, true)) < 1e-13);
        CHECK(std::fabs(flat(q).value - expected_white(q, false)) < 1e-13);
    }
}

TEST_CASE("white: two samples per period of the bandwidth")
{
    const Field made("white(q, 1.5)"), by_hand("white_spline(q * 3.0, 0)"), seeded("white(q.xy, 1.5, 4)"),
        seeded_by_hand("white_spline(q.xy * 3.0, 4)");
    for (const Vec3& q : points_within(40, 100)) {
        CHECK(made(q).value == by_hand(q).value);
        CHECK(seeded(q).value == seeded_by_hand(q).value);
    }
}

TEST_CASE("white: flat below the bandwidth but for the spline's own fall, little above")
{
    // Power along a line at a frequency, averaged over many lines.
    const Field field("white(q.xy, 1.0)");
    const auto power = [&](double frequency) {
        double sum = 0;
        for (int line = 0; line < 120; ++line) {
            double c = 0, s = 0;
            for (int i = 0; i < 512; ++i) {
                const double x = i / 16.0, value = field({x, 3.7 * line, 0}).value;
                const double window = 1 - std::cos(2 * std::numbers::pi * (i + 0.5) / 512);
                c += window * value * std::cos(2 * std::numbers::pi * frequency * x);
                s += window * value * std::sin(2 * std::numbers::pi * frequency * x);
            }
            sum += c * c + s * s;
        }
        return sum;
    };
    // |sinc(f / 2)|^6: the spline at two samples per unit
    const auto fall = [](double f) {
        return std::pow(std::sin(std::numbers::pi * f / 2) / (std::numbers::pi * f / 2), 6);
    };
    const double reference = power(0.2) / fall(0.2);
    for (const double f : {0.1, 0.4, 0.6, 0.8, 1.0}) {
        CAPTURE(f);
        CHECK(power(f) / reference > 0.6 * fall(f));
        CHECK(power(f) / reference < 1.6 * fall(f));
    }
    CHECK(power(2.0) / reference < 1e-3); // beyond the bandwidth
    CHECK(power(1.6) / reference < 0.02);
}
