// Moved places: where they are, and how much they stretch.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace haptel::test;

namespace {

// The greatest length of what a vector of length 1 becomes: of the rows' sums along all directions, by trying them.
double stretch_of(const std::vector<Vec3>& rows)
{
    double most = 0;
    for (int i = 0; i < 60; ++i)
        for (int j = 0; j < 30; ++j) {
            const double a = 2 * std::numbers::pi * i / 60, b = std::numbers::pi * j / 30;
            const Vec3 e{std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)};
            double square = 0;
            for (const Vec3& row : rows) {
                const double along = row[0] * e[0] + row[1] * e[1] + row[2] * e[2];
                square += along * along;
            }
            most = std::max(most, std::sqrt(square));
        }
    return most;
}

} // namespace

TEST_CASE("domain_warp moves by noises of its own along each axis")
{
    const Field x("domain_warp(q.xy, 0.7, 3).x"), y("domain_warp(q.xy, 0.7, 3).y");
    const Field noise_x("perlin(q.xy, 3)"), noise_y("perlin(q.xy + 0.5, 4)");
    const Field sx("domain_warp(q, 0.7, 3).x"), sy("domain_warp(q, 0.7, 3).y"), sz("domain_warp(q, 0.7, 3).z");
    const Field space_x("perlin(q, 3)"), space_y("perlin(q + 0.5, 4)"), space_z("perlin(q + 0.25, 5)");
    const Field other("domain_warp(white_spline, q.xy, 0.7, 3).y"), other_noise("white_spline(q.xy + 0.5, 4)");
    for (const Vec3& q : points_within(20, 1000)) {
        CHECK(std::fabs(x(q).value - q[0] - 0.7 * noise_x(q).value) < 1e-14);
        CHECK(std::fabs(y(q).value - q[1] - 0.7 * noise_y(q).value) < 1e-14);
        CHECK(std::fabs(other(q).value - q[1] - 0.7 * other_noise(q).value) < 1e-14);
        CHECK(stretch_of({x(q).gradient, y(q).gradient}) < 1 + 2.93 * 0.7);
        CHECK(std::fabs(sx(q).value - q[0] - 0.7 * space_x(q).value) < 1e-14);
        CHECK(std::fabs(sy(q).value - q[1] - 0.7 * space_y(q).value) < 1e-14);
        CHECK(std::fabs(sz(q).value - q[2] - 0.7 * space_z(q).value) < 1e-14);
        CHECK(stretch_of({sx(q).gradient, sy(q).gradient, sz(q).gradient}) < 1 + 4.84 * 0.7);
    }
}

TEST_CASE("rotate turns from x to y")
{
    const Field x("rotate(q.xy, 0.1).x"), y("rotate(q.xy, 0.1).y"), quarter("rotate(q.xy, 0.25).y");
    for (const Vec3& q : points_within(5, 200)) {
        const double angle = std::atan2(q[1], q[0]) + 0.2 * std::numbers::pi, away = std::hypot(q[0], q[1]);
        CHECK(std::fabs(x(q).value - away * std::cos(angle)) < 1e-14);
        CHECK(std::fabs(y(q).value - away * std::sin(angle)) < 1e-14);
        CHECK(quarter(q).value == q[0]);
    }
}

TEST_CASE("swirl turns most in the middle and not beyond its radius")
{
    const Field x("swirl(q.xy, 0.3, 1.5).x"), y("swirl(q.xy, 0.3, 1.5).y");
    double most = 0;
    for (const Vec3& q : points_within(2, 3000)) {
        const double away = std::hypot(q[0], q[1]), s = std::min(away / 1.5, 1.0);
        const double angle = std::atan2(q[1], q[0]) + 0.6 * std::numbers::pi * std::pow(1 - s * s, 3);
        CHECK(std::fabs(x(q).value - away * std::cos(angle)) < 1e-14);
        CHECK(std::fabs(y(q).value - away * std::sin(angle)) < 1e-14);
        if (s == 1) CHECK(x(q).value == q[0]);
        most = std::max(most, stretch_of({x(q).gradient, y(q).gradient}));
    }
    CHECK(most < 1 + 5.59 * 0.3);
    CHECK(most > 1 + 2 * 0.3); // not far from it
}
