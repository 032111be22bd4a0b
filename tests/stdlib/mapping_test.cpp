// Two-stage maps against their formulas and Jacobians as worked out by hand (and checked) in the literature.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using namespace haptel::test;

namespace {

const std::string box = "vec3(0.1, -0.2, 0.3), vec3(2.0, 3.0, 4.0))"; // centre and extent
const Vec3 center{0.1, -0.2, 0.3};

void check_near(const FieldSample& found, double value, const Vec3& gradient)
{
    CHECK(std::fabs(found.value - value) < 1e-14);
    for (size_t a = 0; a < 3; ++a)
        CHECK(std::fabs(found.gradient[a] - gradient[a]) < 1e-12 * (1 + std::fabs(gradient[a])));
}

// Longitude in turns, 0 .. 1, and its gradient (-y, x, 0) / (2 pi rho^2).
double turns(double x, double y)
{
    const double angle = std::atan2(y, x) / (2 * std::numbers::pi);
    return angle < 0 ? angle + 1 : angle;
}

} // namespace

TEST_CASE("plane_map and cylinder_map: places between the sides of the box, and the longitude")
{
    const Field u("plane_map(q, " + box + ".x"), v("plane_map(q, " + box + ".y"),
        around("cylinder_map(q, " + box + ".x"), up("cylinder_map(q, " + box + ".y");
    for (const Vec3& q : points_within(2, 200)) {
        const double x = q[0] - center[0], y = q[1] - center[1], z = q[2] - center[2], rho = std::hypot(x, y);
        check_near(u(q), x / 2 + 0.5, {0.5, 0, 0});
        check_near(v(q), y / 3 + 0.5, {0, 1.0 / 3, 0});
        check_near(up(q), z / 4 + 0.5, {0, 0, 0.25});
        check_near(around(q), turns(x, y),
                   {-y / (2 * std::numbers::pi * rho * rho), x / (2 * std::numbers::pi * rho * rho), 0});
    }
    CHECK(Field("plane_map(q, vec3(0.0), vec3(0.0)).x")({1, 2, 3}).value == 0.5);
}

TEST_CASE("sphere_map: longitude and polar angle; both gradients at right angles to the way from the centre")
{
    const Field u("sphere_map(q, " + box + ".x"), v("sphere_map(q, " + box + ".y");
    for (const Vec3& q : points_within(2, 300)) {
        const double x = q[0] - center[0], y = q[1] - center[1], z = q[2] - center[2];
        const double rho = std::hypot(x, y), r = std::hypot(rho, z);
        check_near(u(q), turns(x, y),
                   {-y / (2 * std::numbers::pi * rho * rho), x / (2 * std::numbers::pi * rho * rho), 0});
        const double scale = 1 / (std::numbers::pi * r * r * rho);
        check_near(v(q), std::acos(z / r) / std::numbers::pi, {x * z * scale, y * z * scale, -rho * rho * scale});
    }
    // poles and centre: nothing turns infinitely fast
    for (const Vec3& q : {center, Vec3{0.1, -0.2, 2}, Vec3{0.1, -0.2, -2}}) {
        CHECK(u.faults(q) == 0);
        CHECK(v.faults(q) == 0);
        CHECK(u(q).value == 0);
    }
}

TEST_CASE("cube_map: the point seen from the centre on the face in its way, round the z axis without a jump")
{
    const Field u("cube_map(q, " + box + ".x"), v("cube_map(q, " + box + ".y");
    const auto at = [](double x, double y, double z) { return Vec3{center[0] + x, center[1] + y, center[2] + z}; };
    check_near(u(at(2, 1, 0.5)), 0.75, {-0.125, 0.25, 0});   // face +x: (y / x + 1) / 2
    check_near(v(at(2, 1, 0.5)), 0.625, {-0.0625, 0, 0.25}); // (z / x + 1) / 2
    check_near(u(at(-1, 2, 0.5)), 0.75, {-0.25, -0.125, 0}); // face +y: (-x / y + 1) / 2
    check_near(u(at(-2, -1, 0.5)), 0.75, {0.125, -0.25, 0}); // face -x: (-y / |x| + 1) / 2 = (y / x + 1) / 2
    check_near(u(at(1, -2, 0.5)), 0.75, {0.25, 0.125, 0});   // face -y: (x / |y| + 1) / 2
    check_near(u(at(0.5, 0.25, -1)), 0.75, {0.5, 0, 0.25});  // face -z: (x / |z| + 1) / 2
    check_near(v(at(0.5, 0.25, 1)), 0.625, {0, 0.5, -0.125});
    CHECK(u.faults(center) == 0);
    // a texture of period 1 in u closes at the four upright edges, with its slope along the circle
    const Field closed("sinturn(cube_map(q, " + box + ".x)");
    for (const double turn : {0.125, 0.375, 0.625, 0.875}) {
        for (const double e : {1e-7}) {
            const auto on = [&](double t) {
                return closed(at(std::cos(2 * std::numbers::pi * t), std::sin(2 * std::numbers::pi * t), 0.3));
            };
            const FieldSample before = on(turn - e), after = on(turn + e);
            CHECK(std::fabs(before.value - after.value) < 1e-5);
            for (size_t a = 0; a < 3; ++a) CHECK(std::fabs(before.gradient[a] - after.gradient[a]) < 1e-4);
        }
    }
}

TEST_CASE("pole_fade tames the turns at the poles")
{
    const std::string fade = "pole_fade(q, vec3(0.0), vec3(2.0), 0.25)";
    const Field alone(fade), mapped(fade + " * sinturn(sphere_map(q, vec3(0.0), vec3(2.0)).x)");
    double steepest = 0;
    for (int i = 1; i < 2000; ++i) {
        const double angle = i / 2000.0 * std::numbers::pi, sine = std::sin(angle);
        const Vec3 q{sine * std::cos(1.0), sine * std::sin(1.0), std::cos(angle)};
        const double t = std::clamp(2 * sine / 0.25 - 1, 0.0, 1.0);
        CHECK(std::fabs(alone(q).value - t * t * (3 - 2 * t)) < 1e-13);
        const FieldSample made = mapped(q);
        // along the circle of latitude
        steepest = std::max(steepest, std::fabs(made.gradient[1] * std::cos(1.0) - made.gradient[0] * std::sin(1.0)));
    }
    // |cos(2 pi u)| / sine with u = 1 / (2 pi)
    CHECK(steepest < 1.03 / 0.25 * std::cos(1.0));
    CHECK(steepest > 1.02 / 0.25 * std::cos(1.0));
    CHECK(alone({0, 0, 1}).value == 0);
    CHECK(mapped({0, 0, 1}).value == 0);
    CHECK(mapped({0, 0, 0}).value == 0);
    // a box without width, and one without any size
    CHECK(Field("pole_fade(q, vec3(0.0), vec3(2.0, 0.0, 2.0), 0.5)")({1, 0, 0}).value == 1);
    CHECK(Field("pole_fade(q, vec3(0.0), vec3(0.0), 0.5)")({1, 0, 0}).value == 0);
}

TEST_CASE("center_fade ends flat towards the centre")
{
    const Field fade("center_fade(q, vec3(0.5, 0.0, 0.0), vec3(2.0, 3.0, 4.0), 0.5)");
    for (const Vec3& q : points_within(1, 200)) {
        const double t = std::clamp(4 * std::hypot(q[0] - 0.5, q[1], q[2]) - 1, 0.0, 1.0);
        CHECK(std::fabs(fade(q).value - t * t * (3 - 2 * t)) < 1e-13);
    }
}

TEST_CASE("triplanar: each axis by the fourth power of the normal")
{
    const std::string basis = "float basis(vec2 q) { return sinturn(q.x) + q.y * q.y; }\n";
    const auto b = [](double x, double y) { return std::sin(2 * std::numbers::pi * x) + y * y; };
    const Field field("triplanar(basis, q, normalize(vec3(1.0, 2.0, -2.0)))", basis);
    for (const Vec3& q : points_within(2, 100)) {
        const double expected = (b(q[1], q[2]) + 16 * b(q[2], q[0]) + 16 * b(q[0], q[1])) / 33;
        CHECK(std::fabs(field(q).value - expected) < 1e-13);
    }
    CHECK(Field("triplanar(basis, q, vec3(0.0))", basis).faults({1, 2, 3}) == 0);
    // the normal turns with the point: a sphere seen from its own centre
    const Field turning("triplanar(basis, q, normalize(q))", basis);
    const double h = 1e-5;
    for (const Vec3& q : points_within(2, 50)) {
        const FieldSample here = turning(q);
        for (size_t a = 0; a < 3; ++a) {
            Vec3 before = q, after = q;
            before[a] -= h;
            after[a] += h;
            const double slope = (turning(after).value - turning(before).value) / (2 * h);
            CHECK(std::fabs(here.gradient[a] - slope) < 1e-6 * (1 + 1 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2])));
        }
    }
}

TEST_CASE("fractals over a periodic basis close round a sphere, band-limited or not")
{
    const std::string basis = "float basis(vec2 q) { return perlin_periodic(q, 8, 0); }\n"
                              "float wrapped(vec2 uv) { return fbm(basis, vec2(8.0, 5.0) * uv, 4, 2.0, 0.5); }\n";
    for (const double footprint : {0.0, 0.1}) {
        const Field field("wrapped(sphere_map(q, vec3(0.0), vec3(2.0)))", basis, footprint);
        for (const Vec3& q : points_within(1, 100)) {
            const double x = 0.3 + std::fabs(q[0]); // both sides of the half plane where the longitude is 0
            const FieldSample before = field({x, -1e-12, q[2]}), after = field({x, 1e-12, q[2]});
            CHECK(std::fabs(before.value - after.value) < 1e-9);
            for (size_t a = 0; a < 3; ++a) CHECK(std::fabs(before.gradient[a] - after.gradient[a]) < 1e-7);
        }
    }
}
