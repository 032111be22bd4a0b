// Signed distances against those from the corners of the outline, or from the nearest of all its points.
#include "tests/stdlib/field.h"
#include "tests/stdlib/lines.h"
#include "tests/stdlib/outlines.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

using namespace haptel::test;

namespace {

// The least of a function that falls, then rises.
double least_of(double from, double to, const std::function<double(double)>& f)
{
    for (int i = 0; i < 200; ++i) {
        const double a = from + (to - from) / 3, b = to - (to - from) / 3;
        (f(a) < f(b) ? to : from) = f(a) < f(b) ? b : a;
    }
    return f((from + to) / 2);
}

Vec3 between(const Vec3& a, const Vec3& b, double t)
{
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

double apart(const Vec3& a, const Vec3& b)
{
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Equal to `truth` everywhere, with a gradient of length 1.
void check_distance(const std::string& call, const std::function<double(const Vec3&)>& truth, double rounding = 1e-14)
{
    CAPTURE(call);
    const Field field(call);
    for (const Vec3& q : points_within(2, 2000)) {
        const FieldSample found = field(q);
        CHECK(std::fabs(found.value - truth(q)) < rounding);
        CHECK(std::fabs(std::hypot(found.gradient[0], found.gradient[1], found.gradient[2]) - 1) < 1e-12);
    }
}

std::string numbers(double a, double b)
{
    return std::to_string(a) + ", " + std::to_string(b);
}

} // namespace

TEST_CASE("circles, balls, rings and tubes: as far as from the nearest of their points")
{
    check_distance("sd_circle(q.xy, 0.7)", [](const Vec3& q) { return std::hypot(q[0], q[1]) - 0.7; });
    check_distance("sd_sphere(q, 0.7)", [](const Vec3& q) { return apart(q, {0, 0, 0}) - 0.7; });
    check_distance("sd_ring(q.xy, 0.7, 0.3)", [](const Vec3& q) {
        const double away = std::hypot(q[0], q[1]);
        return away > 0.7 ? away - 0.85 : 0.55 - away;
    });
    check_distance(
        "sd_torus(q, 0.7, 0.3)",
        [](const Vec3& q) {
            const double there = std::atan2(q[1], q[0]);
            return least_of(there - 0.5, there + 0.3,
                            [&](double angle) { return apart(q, {0.7 * std::cos(angle), 0.7 * std::sin(angle), 0}); }) -
                   0.3;
        },
        1e-12);
}

TEST_CASE("boxes of the plane: as far as from the nearest edge, whose corners are circles")
{
    const auto box = [](double x, double y, double rounding) {
        return [=](const Vec3& q) {
            return polygon_distance({q[0], q[1]}, rectangle(rounding - x, rounding - y, x - rounding, y - rounding)) -
                   rounding;
        };
    };
    check_distance("sd_box(q.xy, vec2(0.8, 0.3))", box(0.8, 0.3, 0));
    check_distance("sd_box(q.xy, vec2(0.8, 0.3), 0.2)", box(0.8, 0.3, 0.2));
    check_distance("sd_box(q.xy, vec2(0.8, 0.3), 0.3)", box(0.8, 0.3, 0.3));
    check_distance("sd_box(q.xy, vec2(0.8, 0.3), 9.0)", box(0.8, 0.3, 0.3)); // what fits
    check_distance("sd_box(q.xy, vec2(0.8, 0.3), -1.0)", box(0.8, 0.3, 0));
}

TEST_CASE("boxes in space: outside as far as from the nearest point, inside as from the nearest side")
{
    const auto box = [](const Vec3& half, double rounding) {
        return [=](const Vec3& q) {
            Vec3 nearest{};
            double depth = INFINITY;
            for (size_t a = 0; a < 3; ++a) {
                nearest[a] = std::clamp(q[a], rounding - half[a], half[a] - rounding);
                depth = std::min({depth, half[a] - q[a], half[a] + q[a]});
            }
            return apart(q, nearest) > 0 ? apart(q, nearest) - rounding : -depth;
        };
    };
    check_distance("sd_box(q, vec3(0.8, 0.3, 1.1))", box({0.8, 0.3, 1.1}, 0));
    check_distance("sd_box(q, vec3(0.8, 0.3, 1.1), 0.2)", box({0.8, 0.3, 1.1}, 0.2));
    check_distance("sd_box(q, vec3(0.8, 0.3, 1.1), 0.5)", box({0.8, 0.3, 1.1}, 0.3));
}

TEST_CASE("lines and rods: as far as from the nearest of their points")
{
    const auto plane = [](const Vec3& q) { return segment_distance({q[0], q[1]}, {-0.7, 0.2}, {0.5, -0.4}); };
    check_distance("sd_segment(q.xy, vec2(-0.7, 0.2), vec2(0.5, -0.4))", plane);
    check_distance("sd_capsule(q.xy, vec2(-0.7, 0.2), vec2(0.5, -0.4), 0.3)",
                   [&](const Vec3& q) { return plane(q) - 0.3; });
    const Vec3 a{-0.7, 0.2, 0.1}, b{0.5, -0.4, 1.1};
    const auto space = [&](const Vec3& q) {
        return least_of(0, 1, [&](double t) { return apart(q, between(a, b, t)); });
    };
    check_distance("sd_segment(q, vec3(-0.7, 0.2, 0.1), vec3(0.5, -0.4, 1.1))", space, 1e-12);
    check_distance(
        "sd_capsule(q, vec3(-0.7, 0.2, 0.1), vec3(0.5, -0.4, 1.1), 0.3)", [&](const Vec3& q) { return space(q) - 0.3; },
        1e-12);
    check_distance("sd_segment(q.xy, vec2(0.5), vec2(0.5))",
                   [](const Vec3& q) { return std::hypot(q[0] - 0.5, q[1] - 0.5); });
}

TEST_CASE("hexagons, polygons and stars: as far as from the nearest edge")
{
    const auto outline = [](const std::vector<Vec2>& corners) {
        return [=](const Vec3& q) { return polygon_distance({q[0], q[1]}, corners); };
    };
    const double corner = 0.7 / std::cos(std::numbers::pi / 6);
    check_distance("sd_hexagon(q.xy, 0.7)", outline(corners_round(6, corner, corner, std::numbers::pi / 6)));
    check_distance("sd_hexagon(q.xy, 0.0)", outline({{0, 0}}));
    check_distance("sd_hexagon(q.xy, -1.0)", outline({{0, 0}}));
    for (const int sides : {3, 4, 5, 6, 11}) {
        const double radius = 0.7 / std::cos(std::numbers::pi / sides);
        check_distance("sd_polygon(q.xy, " + std::to_string(sides) + ", 0.7)",
                       outline(corners_round(sides, radius, radius, std::numbers::pi / sides)));
    }
    for (const int points : {2, 3, 5, 8})
        for (const double inner : {0.1, 0.4, 0.9, 1.3})
            check_distance("sd_star(q.xy, " + std::to_string(points) + ", " + numbers(1, inner) + ")",
                           outline(corners_round(2 * points, 1, inner, 0)));
    check_distance("sd_star(q.xy, -3, 1.0, 0.4)", outline(corners_round(4, 1, 0.4, 0)));
    check_distance("sd_star(q.xy, 5, 0.0, 0.0)", outline({{0, 0}}));
}

TEST_CASE("shapes joined, cut and taken away: of both, near the least or the greatest distance, and without a kink")
{
    const Field a("sd_circle(q.xy, 0.7)"), b("sd_circle(q.xy - vec2(0.8, 0.1), 0.5)");
    const std::string both = "(sd_circle(q.xy, 0.7), sd_circle(q.xy - vec2(0.8, 0.1), 0.5), 0.2)";
    const Field joined("sd_union" + both), common("sd_intersection" + both), rest("sd_subtraction" + both);
    for (const Vec3& q : points_within(2, 2000)) {
        const double in_a = a(q).value, in_b = b(q).value;
        const auto rounding = [](double x, double y) { // what a parabola adds that meets both slopes where x - y is 0.2
            return std::pow(std::max(0.2 - std::fabs(x - y), 0.0), 2) / 0.8;
        };
        CHECK(std::fabs(joined(q).value - std::min(in_a, in_b) + rounding(in_a, in_b)) < 1e-14);
        CHECK(std::fabs(common(q).value - std::max(in_a, in_b) - rounding(in_a, in_b)) < 1e-14);
        CHECK(std::fabs(rest(q).value - std::max(in_a, -in_b) - rounding(in_a, -in_b)) < 1e-14);
    }
    CHECK(jumps_along_lines(joined, 2, 400).gradient < 1e-7); // lines pass the middle of a circle at some distance
    CHECK(
        jumps_along_lines(Field("min(sd_circle(q.xy, 0.7), sd_circle(q.xy - vec2(0.8, 0.1), 0.5))"), 2, 400).gradient >
        0.1);
}

TEST_CASE("outline is half a width thick to each side, relief falls by a cubic over its flank")
{
    const Field line("outline(sd_circle(q.xy, 0.7), 0.2)"), disc("relief(sd_circle(q.xy, 0.7), 0.2)");
    for (const Vec3& q : points_within(2, 2000)) {
        const double away = std::hypot(q[0], q[1]), t = std::clamp((0.8 - away) / 0.2, 0.0, 1.0);
        CHECK(std::fabs(line(q).value - std::max(away - 0.8, 0.6 - away)) < 1e-14);
        CHECK(std::fabs(disc(q).value - (3 * t * t - 2 * t * t * t)) < 1e-14);
    }
    CHECK(disc({0.3, 0.4, 0}).value == 1);
    CHECK(disc({0, 0.81, 0}).value == 0);
    CHECK(jumps_along_lines(disc, 2, 400).gradient < 1e-8); // level long before the middle
}
