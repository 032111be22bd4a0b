// Rounded kinks and regular patterns: what their comments promise.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

using namespace haptel::test;

namespace {

// Largest change of the gradient over a step, per length: finite for a function whose gradient is continuous and bends
// only so much, of the order of 1 / step for one with a kink.
double steepest_change(const Field& field, double size, double step)
{
    double largest = 0;
    for (double x = -size; x < size; x += step) {
        const double change = field({x + step, 0.37, 0}).gradient[0] - field({x, 0.37, 0}).gradient[0];
        largest = std::max(largest, std::abs(change) / step);
    }
    return largest;
}

} // namespace

TEST_CASE("smoothabs: 0 at 0, below |x| by at most k, curvature at most 1 / k")
{
    const Field field("smoothabs(q.x, 0.2)");
    CHECK(field({0, 0, 0}).value == 0);
    CHECK(field({0, 0, 0}).gradient[0] == 0);
    for (double x = -3; x < 3; x += 0.01) {
        const double value = field({x, 0, 0}).value;
        CHECK(value >= 0);
        CHECK(value <= std::abs(x) + 1e-15);
        CHECK(value >= std::abs(x) - 0.2);
        CHECK(std::abs(value - (std::sqrt(x * x + 0.04) - 0.2)) < 1e-15);
    }
    CHECK(steepest_change(field, 1, 1e-3) <= 5.0);
    CHECK(steepest_change(field, 1, 1e-3) > 4.9);
    CHECK(steepest_change(Field("abs(q.x)"), 1, 1e-3) > 900);
}

TEST_CASE("smoothmin and smoothmax: off by at most k / 4, and only where the two are within k")
{
    const Field low("smoothmin(q.x, q.y, 0.4)"), high("smoothmax(q.x, q.y, 0.4)"), swapped("smoothmin(q.y, q.x, 0.4)");
    for (const Vec3& q : points_within(1, 5000)) {
        const double least = std::min(q[0], q[1]), most = std::max(q[0], q[1]), apart = most - least;
        const double t = std::max(0.4 - apart, 0.0) / 0.4;
        CHECK(std::abs(low(q).value - (least - 0.1 * t * t)) < 1e-15);
        CHECK(std::abs(high(q).value - (most + 0.1 * t * t)) < 1e-15);
        CHECK(low(q).value == swapped(q).value);
        // Weights of the two arguments: together 1, none below 0.
        const Vec3 weights = low(q).gradient;
        CHECK(std::abs(weights[0] + weights[1] - 1) < 1e-14);
        CHECK(std::min(weights[0], weights[1]) >= 0);
    }
    CHECK(steepest_change(Field("smoothmin(q.x, 0.1, 0.4)"), 1, 1e-3) < 1 / (2 * 0.4) + 1e-9);
}

TEST_CASE("wave is a sine of period 1")
{
    const Field field("wave(q.x)");
    for (const Vec3& q : points_within(3, 200)) {
        CHECK(std::abs(field(q).value - std::sin(2 * 3.14159265358979323846 * q[0])) < 1e-14);
    }
    CHECK(field({0.25, 0, 0}).value == 1);
    CHECK(field({1e6 + 0.25, 0, 0}).value == 1);
}

TEST_CASE("grating: flat bars and grooves, rounded flanks, as wide as asked")
{
    const Field field("grating(q.x, 0.4, 0.2)");
    for (int period = -2; period < 3; ++period) {
        CHECK(field({period + 0.5, 0, 0}).value == 1);
        CHECK(field({period + 0.5 + 0.09, 0, 0}).value == 1);
        CHECK(std::abs(field({period + 0.5 + 0.2, 0, 0}).value - 0.5) < 1e-12); // a flank's middle
        CHECK(field({period + 0.5 + 0.31, 0, 0}).value == 0);
        CHECK(field({period + 0.0, 0, 0}).value == 0);
    }
    CHECK(steepest_change(field, 2, 1e-4) < 6 / (0.2 * 0.2) + 1e-6); // a cubic over 0.2
    for (const char* extreme : {"grating(q.x, 0.0, 0.0)", "grating(q.x, 1.0, 1.0)", "grating(q.x, 0.5, 9.0)"}) {
        CHECK(steepest_change(Field(extreme), 2, 1e-4) < 6 / (0.01 * 0.01) + 1e-6);
    }
}

TEST_CASE("bumps: one in the middle of each cell, flat between")
{
    const Field field("bumps(q.xy, 0.3)");
    CHECK(field({0.5, 0.5, 0}).value == 1);
    CHECK(field({7.5, -2.5, 0}).value == 1);
    CHECK(field({0, 0.3, 0}).value == 0);
    CHECK(std::abs(field({0.5 + 0.15, 0.5, 0}).value - 0.75 * 0.75 * 0.75) < 1e-15);
    CHECK(field({0.5 + 0.31, 0.5, 0}).value == 0);
    CHECK(steepest_change(field, 2, 1e-4) < 6 / 0.09 + 1e-6);
}

TEST_CASE("weave: the warp over the weft in every other cell, both at their full height in the middle")
{
    const Field field("weave(q.xy)");
    for (int i = -2; i < 3; ++i)
        for (int j = -2; j < 3; ++j) {
            const Vec3 middle{i + 0.5, j + 0.5, 0};
            CHECK(std::abs(field(middle).value - 1) < 1e-12);
            // along the thread on top the height falls like 1 + sin towards the next cell, where it goes below
            const bool warp = (i + j) % 2 == 0;
            const double t = 0.1, along = 0.5 * (1 + std::cos(3.14159265358979323846 * t));
            CHECK(std::abs(field({middle[0] + (warp ? 0 : t), middle[1] + (warp ? t : 0), 0}).value - along) < 1e-12);
        }
    for (int i = 0; i < 4; ++i) CHECK(field({1.0 * i, 2.0, 0}).value == 0.0625); // between threads: the rounding alone
    CHECK(steepest_change(field, 2, 1e-4) < 100.3);
}
