// The hybrid multifractal by its definition, over a basis that is differentiated by hand.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

using namespace haptel::test;

namespace {

// min(x, 1), rounded over 0.25, and its derivative
double cut(double x)
{
    const double t = std::max(0.25 - std::fabs(x - 1), 0.0) / 0.25;
    return std::min(x, 1.0) - 0.0625 * t * t;
}
double cut_slope(double x)
{
    const double t = std::max(0.25 - std::fabs(x - 1), 0.0) / 0.25;
    return x < 1 ? 1 - t / 2 : t / 2;
}

FieldSample expected_hybrid(const Vec3& q, int octaves, double lacunarity, double gain, double footprint)
{
    FieldSample sum{};
    double weight = 1, frequency = 1, amplitude = 1;
    Vec3 weight_slope{};
    for (int i = 0; i < octaves; ++i) {
        const double x = q[0] * frequency + 1.375 * i, y = q[1] * frequency + 0.625 * i,
                     z = q[2] * frequency + 0.1875 * i;
        const double b = amplitude * (std::sin(x) * std::cos(y) + 0.5 * std::sin(z) + 0.7);
        const Vec3 slope{amplitude * frequency * std::cos(x) * std::cos(y),
                         -amplitude * frequency * std::sin(x) * std::sin(y), amplitude * frequency * 0.5 * std::cos(z)};
        const double signal = weight * b, left = octave_left(footprint * std::sqrt(3.0) * frequency);
        sum.value += left * signal;
        for (size_t a = 0; a < 3; ++a) {
            const double signal_slope = weight_slope[a] * b + weight * slope[a];
            sum.gradient[a] += left * signal_slope;
            weight_slope[a] = cut_slope(signal) * signal_slope;
        }
        weight = cut(signal);
        frequency *= lacunarity;
        amplitude *= gain;
    }
    return sum;
}

} // namespace

TEST_CASE("hybrid is what its comment says, band-limited, and so is its gradient")
{
    for (const double footprint : {0.0, 0.05, 0.2}) {
        const Field field("hybrid(basis, q, 6, 1.9, 0.8)", own_basis, footprint);
        for (const Vec3& q : points_within(3, 500)) {
            const FieldSample wanted = expected_hybrid(q, 6, 1.9, 0.8, footprint), found = field(q);
            CHECK(std::fabs(found.value - wanted.value) < 1e-12);
            for (size_t a = 0; a < 3; ++a) CHECK(std::fabs(found.gradient[a] - wanted.gradient[a]) < 1e-11);
        }
    }
}

TEST_CASE("hybrid: short forms are the long ones with perlin, 2, 0.5 and seed 0")
{
    for (const std::string q : {"q", "q.xy"}) {
        const std::pair<std::string, std::string> same[] = {
            {"hybrid(" + q + ", 5)", "hybrid(perlin, " + q + ", 5, 2.0, 0.5)"},
            {"hybrid(" + q + ", 5, 9)", "hybrid(perlin, " + q + ", 5, 2.0, 0.5, 9)"},
            {"hybrid(" + q + ", 16)", "hybrid(" + q + ", 17)"},
            {"hybrid(" + q + ", 1)", "perlin(" + q + ") + 0.7"},
            {"hybrid(" + q + ", 0)", "0.0 * q.x"},
            {"hybrid(noise, " + q + ", 3, 2.0, 0.5)", "hybrid(noise, " + q + ", 3, 2.0, 0.5, 0)"}};
        for (const auto& [a, b] : same) {
            CAPTURE(a, b);
            const Field first(a, own_basis), second(b, own_basis);
            for (const Vec3& at : points_within(20, 50)) {
                CHECK(first(at).value == second(at).value);
                CHECK(first(at).gradient == second(at).gradient);
            }
        }
    }
}
