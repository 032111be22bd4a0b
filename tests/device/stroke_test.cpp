#include "device/stroke.h"
#include "tests/device/surfaces.h"
#include "tests/support/catch.h"

#include <cmath>
#include <vector>

using namespace haptel::device;
using haptel::runtime::SurfaceHit;

namespace {

CurveRequest plate() // 100 mm wide, 60 mm deep, its middle at (10, -5) mm
{
    CurveRequest request;
    request.box_minimum_m = {-0.04, -0.035};
    request.box_maximum_m = {0.06, 0.025};
    request.anchor_m = {0.01, -0.005};
    request.speed_m_per_s = 0.08;
    return request;
}

constexpr double step_s = 1e-3;

// Path length per time over the first `seconds`.
double mean_speed(const Curve& curve, double seconds)
{
    double length_m = 0;
    const int steps = static_cast<int>(seconds / step_s);
    for (int i = 0; i < steps; ++i) length_m += glm::distance(curve(i * step_s).xy_m, curve((i + 1) * step_s).xy_m);
    return length_m / (steps * step_s);
}

} // namespace

TEST_CASE("circles run round the anchor at 0.15 of the smaller side, counterclockwise, at the speed asked for")
{
    const Curve curve = make_curve("circles", plate());
    for (int i = 0; i < 5000; ++i) {
        const CurvePoint point = curve(i * step_s);
        const glm::dvec2 arm = point.xy_m - glm::dvec2(0.01, -0.005);
        REQUIRE(std::abs(glm::length(arm) - 0.15 * 0.06) < 1e-15);
        REQUIRE(point.lift_m == 0);
        REQUIRE(point.press == 1);
        const glm::dvec2 moved = curve((i + 1) * step_s).xy_m - point.xy_m;
        REQUIRE(arm.x * moved.y - arm.y * moved.x > 0);
    }
    CHECK(std::abs(mean_speed(curve, 5) / 0.08 - 1) < 1e-4); // chords of 8.9 mrad, short by 3e-6
}

TEST_CASE("scan covers the central 60 % in lines along x, there and back, at the speed asked for")
{
    const Curve curve = make_curve("scan", plate());
    const glm::dvec2 low(-0.02, -0.023), high(0.04, 0.013);
    glm::dvec2 lowest(1), highest(-1);
    int slanted = 0;
    for (double t = 0; t < 25; t += step_s) {
        const glm::dvec2 xy = curve(t).xy_m;
        lowest = glm::min(lowest, xy);
        highest = glm::max(highest, xy);
        const glm::dvec2 moved = curve(t + step_s).xy_m - xy;
        REQUIRE(glm::length(moved) < 0.08 * step_s + 1e-12);
        slanted += moved.x != 0 && moved.y != 0;
    }
    CHECK(slanted <= 2 * 30); // only steps that go round one of the two corners of a line
    CHECK(glm::distance(lowest, low) < 1e-12);
    CHECK(glm::distance(highest, high) < 1e-4); // the far corner falls between two samples
    // 12 steps of 3 mm, 13 lines of 60 mm: the far end is reached after 816 mm and the start again after twice that.
    CHECK(glm::distance(curve(0.816 / 0.08).xy_m, high) < 1e-12);
    CHECK(glm::distance(curve(2 * 0.816 / 0.08).xy_m, low) < 1e-12);
    CHECK(std::abs(mean_speed(curve, 20) / 0.08 - 1) < 0.002); // corners are cut by the sampling
}

TEST_CASE("press is one second on the surface and half a second off it, at the anchor")
{
    const Curve curve = make_curve("press", plate());
    const double travel_s = press_lift_m / 0.08;
    for (int cycle = 0; cycle < 3; ++cycle) {
        const double start = 1.5 * cycle;
        for (double t = 0; t < 1.5 - 1e-9; t += step_s) {
            const CurvePoint point = curve(start + t + 1e-9);
            REQUIRE(point.xy_m == glm::dvec2(0.01, -0.005));
            REQUIRE(point.press == (t < 1 - 1e-6 ? 1.0 : 0.0));
            if (t > travel_s + 1e-6 && t < 1 - 1e-6) REQUIRE(point.lift_m == 0);
            if (t > 1 + travel_s + 1e-6) REQUIRE(point.lift_m == press_lift_m);
        }
    }
    CHECK(curve(0).lift_m == 0);                                                      // begins on the surface
    CHECK(std::abs(curve(1.5 + 0.01).lift_m - (press_lift_m - 0.01 * 0.08)) < 1e-12); // comes down at the speed
    CHECK(std::abs(curve(1.0 + 0.01).lift_m - 0.01 * 0.08) < 1e-12);                  // and lifts at it
}

TEST_CASE("random stays in the central 60 %, keeps the root mean square speed, and is its seed's")
{
    CurveRequest request = plate();
    request.seed = 7;
    const Curve curve = make_curve("random", request), twin = make_curve("random", request);
    request.seed = 8;
    const Curve other = make_curve("random", request);
    const glm::dvec2 low(-0.02, -0.023), high(0.04, 0.013);
    double squares = 0, fastest = 0, apart = 0;
    const int steps = 400'000;
    for (int i = 0; i < steps; ++i) {
        const glm::dvec2 xy = curve(i * step_s).xy_m;
        REQUIRE(glm::all(glm::greaterThanEqual(xy, low - 1e-15)));
        REQUIRE(glm::all(glm::lessThanEqual(xy, high + 1e-15)));
        REQUIRE(xy == twin(i * step_s).xy_m);
        const double speed = glm::distance(curve((i + 1) * step_s).xy_m, xy) / step_s;
        squares += speed * speed;
        fastest = std::max(fastest, speed);
        apart = std::max(apart, glm::distance(xy, other(i * step_s).xy_m));
    }
    CHECK(std::abs(std::sqrt(squares / steps) / 0.08 - 1) < 0.03); // an average over 400 s of waves of a few seconds
    CHECK(fastest < 4 * 0.08);
    CHECK(apart > 0.01);
}

TEST_CASE("curves over boxes without area stand still, and unknown names have no curve")
{
    CurveRequest line = plate();
    line.box_minimum_m = line.box_maximum_m = line.anchor_m;
    for (const std::string_view name : stroke_names()) {
        const Curve curve = make_curve(name, line);
        REQUIRE(curve);
        for (double t = 0; t < 3; t += 0.1) CHECK(glm::distance(curve(t).xy_m, line.anchor_m) < 1e-15);
    }
    CHECK(!make_curve("spirals", plate()));
    CHECK(!make_curve("", plate()));
}

TEST_CASE("a miss keeps the last hit")
{
    // Moves along x at 1 m/s over a table that ends at x = 0.5.
    const auto along_x = [](double time_s) { return CurvePoint{{time_s, 0}}; };
    const auto table = plane_where([](double x, double) { return x <= 0.5; });
    Stroke stroke(along_x, table, *table(0, 0));
    double last_x = 0;
    for (double t = 0; t < 3; t += step_s) {
        const StrokeTarget target = stroke.at(t);
        REQUIRE(target.point_m.x <= 0.5);
        REQUIRE(target.point_m.x >= last_x);
        last_x = target.point_m.x;
    }
    CHECK(last_x > 0.499);
    CHECK(stroke.at(3).point_m.z == 0);
}

TEST_CASE("a stroke comes down from above before it presses and moves")
{
    Stroke stroke(make_curve("circles", plate()), plane_at(0.02), *plane_at(0.02)(0, 0));
    StrokeTarget before = stroke.at(0);
    CHECK(std::abs(before.point_m.z - 0.02 - approach_m) < 1e-15);
    for (double t = step_s; t <= approach_s; t += step_s) {
        const StrokeTarget target = stroke.at(t);
        REQUIRE(target.point_m.z <= before.point_m.z);
        REQUIRE(glm::dvec2(target.point_m) == glm::dvec2(before.point_m));
        REQUIRE(target.press == 0);
        before = target;
    }
    CHECK(std::abs(stroke.at(approach_s).point_m.z - 0.02) < 1e-15);
    double press = 0;
    for (double t = approach_s; t < approach_s + press_onset_s; t += step_s) {
        const StrokeTarget target = stroke.at(t);
        REQUIRE(target.press >= press);
        REQUIRE(glm::distance(target.point_m, before.point_m) <= 0.08 * step_s * (1 + 1e-9)); // never faster
        press = target.press;
        before = target;
    }
    CHECK(stroke.at(approach_s + press_onset_s).press == 1);
}

TEST_CASE("the start is the hit nearest to the centre of the box")
{
    const glm::dvec2 low(-0.05), high(0.05);
    const auto centre = nearest_hit(plane_at(0.01), low, high);
    REQUIRE(centre);
    CHECK(centre->point_m == glm::dvec3(0, 0, 0.01));

    // A ring with a hole of 20 mm: the nearest point of a grid of 1 mm is at most its diagonal further out.
    const auto ring = plane_where([](double x, double y) { return std::hypot(x, y) >= 0.02; });
    const auto rim = nearest_hit(ring, low, high);
    REQUIRE(rim);
    const double distance = glm::length(glm::dvec2(rim->point_m));
    CHECK(distance >= 0.02);
    CHECK(distance <= 0.02 + std::sqrt(2) * 1e-3);

    CHECK(!nearest_hit(plane_where([](double, double) { return false; }), low, high));
}
