#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

using namespace haptel::test;

namespace {

// The definition, over a basis that is differentiated by hand.
FieldSample expected_sum(double (*shape)(double), double (*shape_slope)(double), const Vec3& q, int octaves,
                         double lacunarity, double gain, double footprint)
{
    FieldSample sum{};
    double frequency = 1;
    for (int i = 0; i < octaves; ++i) {
        const double amplitude = octave_left(footprint * std::sqrt(3.0) * frequency) * std::pow(gain, i);
        const double x = q[0] * frequency + 1.375 * i, y = q[1] * frequency + 0.625 * i,
                     z = q[2] * frequency + 0.1875 * i;
        const double b = std::sin(x) * std::cos(y) + 0.5 * std::sin(z), outer = amplitude * frequency * shape_slope(b);
        sum.value += amplitude * shape(b);
        sum.gradient[0] += outer * std::cos(x) * std::cos(y);
        sum.gradient[1] -= outer * std::sin(x) * std::sin(y);
        sum.gradient[2] += outer * 0.5 * std::cos(z);
        frequency *= lacunarity;
    }
    return sum;
}

void check_definition(const std::string& name, double (*shape)(double), double (*shape_slope)(double))
{
    // Of 6 octaves the third fades at a footprint of 0.13 wavelengths, and at one of 0.4 the first.
    for (const double footprint : {0.0, 0.01, 0.13, 0.4, 0.6}) {
        CAPTURE(name, footprint);
        const Field field(name + "(basis, q, 6, 1.9, 0.6)", own_basis, footprint);
        for (const Vec3& q : points_within(3, 500)) {
            const FieldSample expected = expected_sum(shape, shape_slope, q, 6, 1.9, 0.6, footprint), found = field(q);
            CHECK(std::abs(found.value - expected.value) < 1e-13);
            for (size_t a = 0; a < 3; ++a) CHECK(std::abs(found.gradient[a] - expected.gradient[a]) < 1e-12);
        }
    }
}

void check_same(const std::string& a, const std::string& b)
{
    CAPTURE(a, b);
    const Field first(a, own_basis), second(b, own_basis);
    for (const Vec3& q : points_within(20, 50)) {
        CHECK(first(q).value == second(q).value);
        CHECK(first(q).gradient == second(q).gradient);
    }
}

double correlation(const Field& a, const Field& b)
{
    double ab = 0, aa = 0, bb = 0, mean_a = 0, mean_b = 0;
    const std::vector<Vec3> points = points_within(60, 10'000);
    for (const Vec3& q : points) {
        mean_a += a(q).value / static_cast<double>(points.size());
        mean_b += b(q).value / static_cast<double>(points.size());
    }
    for (const Vec3& q : points) {
        const double x = a(q).value - mean_a, y = b(q).value - mean_b;
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    return ab / std::sqrt(aa * bb);
}

} // namespace

TEST_CASE("fractals are what their comments say, and so are their gradients")
{
    check_definition("fbm", [](double b) { return b; }, [](double) { return 1.0; });
    check_definition("turbulence", [](double b) { return std::abs(b); }, [](double b) { return b < 0 ? -1.0 : 1.0; });
    check_definition(
        "ridged", [](double b) { return (1 - std::abs(b)) * (1 - std::abs(b)); },
        [](double b) { return (b < 0 ? 2 : -2) * (1 - std::abs(b)); });
}

TEST_CASE("where coordinates stretch, octaves fade, and the gradient knows")
{
    // One octave of b = sin(w.x) cos(w.y) at w = (x^2, x y), whose Jacobian has the norm sqrt(5 x^2 + y^2).
    const double footprint = 0.2;
    const Field field("fbm(flat_basis, vec2(q.x * q.x, q.x * q.y), 1, 2.0, 0.5)", own_basis, footprint);
    int fading = 0;
    for (const Vec3& q : points_within(2, 500)) {
        const double x = q[0], y = q[1], norm = std::sqrt(5 * x * x + y * y), detail = footprint * norm;
        const double b = std::sin(x * x) * std::cos(x * y), t = 2 * detail - 1;
        const double left = octave_left(detail), slope = t > 0 && t < 1 ? -2 * 6 * t * (1 - t) * footprint / norm : 0;
        const double by_first = std::cos(x * x) * std::cos(x * y), by_second = -std::sin(x * x) * std::sin(x * y);
        const FieldSample found = field(q);
        CHECK(std::abs(found.value - left * b) < 1e-14);
        CHECK(std::abs(found.gradient[0] - (slope * 5 * x * b + left * (2 * x * by_first + y * by_second))) < 1e-13);
        CHECK(std::abs(found.gradient[1] - (slope * y * b + left * x * by_second)) < 1e-13);
        fading += slope != 0;
    }
    CHECK(fading > 100);
}

TEST_CASE("short forms are the long ones with perlin, 2, 0.5 and seed 0")
{
    for (const std::string name : {"fbm", "turbulence", "ridged"}) {
        for (const std::string q : {"q", "q.xy"}) {
            check_same(name + "(" + q + ", 5)", name + "(perlin, " + q + ", 5, 2.0, 0.5)");
            check_same(name + "(" + q + ", 5)", name + "(" + q + ", 5, 0)");
            check_same(name + "(" + q + ", 5, 9)", name + "(perlin, " + q + ", 5, 2.0, 0.5, 9)");
            check_same(name + "(" + q + ", 16)", name + "(" + q + ", 17)");
            check_same(name + "(" + q + ", 0)", "0.0 * q.x");
            check_same(name + "(" + q + ", -1)", "0.0 * q.x");
        }
        check_same(name + "(noise, q.xy, 3, 2.0, 0.5)", name + "(noise, q.xy, 3, 2.0, 0.5, 0)");
    }
    check_same("fbm(q, 1)", "perlin(q)");
    check_same("fbm(noise, q.xy, 1, 2.0, 0.5)", "noise(q.xy)");
}

TEST_CASE("an octave more leaves the scale of the rest")
{
    const Field four("fbm(q, 4)"), five("fbm(q, 5)");
    for (const Vec3& q : points_within(20, 2000)) CHECK(std::abs(five(q).value - four(q).value) <= 0.866026 / 16);
}

TEST_CASE("octaves do not vanish together at the origin")
{
    const Field fbm("fbm(q, 5)");
    int zeros = 0;
    for (int i = -3; i <= 3; ++i) zeros += std::abs(fbm({1.0 * i, 2.0 * i, -1.0 * i}).value) < 0.01;
    CHECK(zeros <= 2);
}

TEST_CASE("seeds give unrelated fractals, of any basis")
{
    // Folded fields have something in common wherever two lattices happen to lie near each other: one pair of seeds may
    // agree by a tenth, many pairs may not.
    for (const std::string name : {"fbm", "turbulence", "ridged"}) {
        for (const std::string arguments : {"q, 4, ", "q.xy, 4, ", "noise, q.xy, 4, 2.0, 0.5, "}) {
            CAPTURE(name, arguments);
            double sum = 0;
            Field before(name + "(" + arguments + "0)");
            for (int seed = 1; seed <= 5; ++seed) {
                const Field field(name + "(" + arguments + std::to_string(seed) + ")");
                const double agreement = std::abs(correlation(before, field));
                CHECK(agreement < (name == "fbm" ? 0.06 : 0.15));
                sum += agreement;
                before = field;
            }
            CHECK(sum / 5 < (name == "fbm" ? 0.03 : 0.08));
        }
    }
}
