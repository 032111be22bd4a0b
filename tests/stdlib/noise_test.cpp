// noise and perlin against the closed form of Appendix C (C.1 to C.5, the permutation nested, the dot product written
// out), as a sum over corners with products of weights, differentiated by hand.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace haptel::test;

namespace {

struct Weight {
    double value, derivative;
};

// Omega of C.3 in one direction and its derivative: 1 - 3 t^2 + 2 t^3.
Weight cubic(double t)
{
    return {1 - 3 * t * t + 2 * t * t * t, -6 * t + 6 * t * t};
}

Weight quintic(double t)
{
    const double t2 = t * t;
    return {1 - (6 * t2 * t2 * t - 15 * t2 * t2 + 10 * t2 * t), -(30 * t2 * t2 - 60 * t2 * t + 30 * t2)};
}

struct Tables {
    std::vector<double> permutation, x, y, z, plane_x, plane_y;
};

Tables tables_of(const std::string& prefix)
{
    return {library_table(prefix + "_m"),  library_table(prefix + "_gx"),       library_table(prefix + "_gy"),
            library_table(prefix + "_gz"), library_table(prefix + "_plane_gx"), library_table(prefix + "_plane_gy")};
}

size_t wrapped(double whole)
{
    return static_cast<size_t>(whole - 256 * std::floor(whole / 256));
}

FieldSample closed_form(const Tables& tables, Weight (*weight)(double), int dimensions, const Vec3& q)
{
    double cell[3] = {}, d[3] = {};
    for (int a = 0; a < dimensions; ++a) {
        cell[a] = std::floor(q[a]);
        d[a] = q[a] - cell[a];
    }
    FieldSample sum{};
    for (int corner = 0; corner < 1 << dimensions; ++corner) {
        size_t hash = 0;
        double vector[3] = {}, way[3] = {}, omega[3] = {1, 1, 1}, omega_slope[3] = {};
        for (int a = 0; a < 3; ++a) {
            const int far = a < dimensions ? corner >> a & 1 : 0;
            // M[(M[(M[i mod 256] + j) mod 256] + k) mod 256]
            hash = static_cast<size_t>(tables.permutation[wrapped(static_cast<double>(hash) + cell[a] + far)]);
            if (a >= dimensions) continue;
            way[a] = d[a] - far;
            const Weight w = weight(far ? 1 - d[a] : d[a]);
            omega[a] = w.value;
            omega_slope[a] = far ? -w.derivative : w.derivative;
        }
        const size_t index = hash % tables.x.size();
        vector[0] = (dimensions == 3 ? tables.x : tables.plane_x)[index];
        vector[1] = (dimensions == 3 ? tables.y : tables.plane_y)[index];
        vector[2] = dimensions == 3 ? tables.z[index] : 0;
        const double product = vector[0] * way[0] + vector[1] * way[1] + vector[2] * way[2];
        sum.value += omega[0] * omega[1] * omega[2] * product;
        for (size_t a = 0; a < 3; ++a) { // C.5: both factors depend on the place
            double others = 1;
            for (size_t b = 0; b < 3; ++b) {
                if (b != a) others *= omega[b];
            }
            sum.gradient[a] += omega_slope[a] * others * product + omega[0] * omega[1] * omega[2] * vector[a];
        }
    }
    return sum;
}

void check_closed_form(const std::string& name, Weight (*weight)(double), int dimensions)
{
    const Tables tables = tables_of(name);
    const double wavelength = 0.003, depth = 50e-6;
    const std::string argument = dimensions == 3 ? "q / 0.003" : "q.xy / 0.003";
    const Field field("50um / 1m * " + name + "(" + argument + ")");
    const std::string d = "d" + name + "(" + argument + ")";
    const Field derivative[2] = {Field(d + ".x"), Field(d + ".y")};
    double value_error = 0, gradient_error = 0;
    for (const double size : {0.05, 5.0}) {
        for (const Vec3& p : points_within(size, 2000)) {
            const Vec3 q{p[0] / wavelength, p[1] / wavelength, p[2] / wavelength};
            const FieldSample expected = closed_form(tables, weight, dimensions, q), found = field(p);
            value_error = std::max(value_error, std::abs(found.value - depth * expected.value) / depth);
            for (size_t a = 0; a < 3; ++a) { // the factor 1 / wavelength that the paper leaves out
                const double exact = depth / wavelength * expected.gradient[a];
                gradient_error = std::max(gradient_error, std::abs(found.gradient[a] - exact) * wavelength / depth);
            }
            for (size_t a = 0; a < 2; ++a)
                gradient_error = std::max(gradient_error, std::abs(derivative[a](p).value - expected.gradient[a]));
        }
    }
    CHECK(value_error < 1e-14);
    CHECK(gradient_error < 4e-14);
}

double mean(const Field& field, const std::vector<Vec3>& points, const std::function<double(const FieldSample&)>& what)
{
    double sum = 0;
    for (const Vec3& q : points) sum += what(field(q));
    return sum / static_cast<double>(points.size());
}

double correlation(const Field& a, const Field& b, const std::vector<Vec3>& points)
{
    double ab = 0, aa = 0, bb = 0;
    for (const Vec3& q : points) {
        const double x = a(q).value, y = b(q).value;
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    return ab / std::sqrt(aa * bb);
}

} // namespace

TEST_CASE("noise and its gradient are the closed form of C.3 to C.5")
{
    check_closed_form("noise", cubic, 3);
    check_closed_form("noise", cubic, 2);
}

TEST_CASE("perlin and its gradient are the same with quintic weights")
{
    check_closed_form("perlin", quintic, 3);
    check_closed_form("perlin", quintic, 2);
}

TEST_CASE("the tables are what Appendix C asks for")
{
    for (const std::string name : {"noise", "perlin"}) {
        CAPTURE(name);
        const Tables tables = tables_of(name);
        std::vector<double> sorted = tables.permutation;
        std::sort(sorted.begin(), sorted.end());
        REQUIRE(sorted.size() == 256);
        for (size_t i = 0; i < 256; ++i) CHECK(sorted[i] == static_cast<double>(i));
        CHECK(tables.x.size() == (name == "noise" ? 256 : 32));
        double sum[3] = {};
        for (size_t i = 0; i < tables.x.size(); ++i) {
            CHECK(std::abs(std::hypot(tables.x[i], tables.y[i], tables.z[i]) - 1) < 1e-15);
            CHECK(std::abs(std::hypot(tables.plane_x[i], tables.plane_y[i]) - 1) < 1e-15);
            sum[0] += tables.x[i];
            sum[1] += tables.y[i];
            sum[2] += tables.z[i];
        }
        for (const double s : sum)
            CHECK(std::abs(s) / static_cast<double>(tables.x.size()) < (name == "noise" ? 0.1 : 1e-15));
    }
}

TEST_CASE("perlin's 32 directions keep 37 degrees apart and are equally strong whichever way one looks")
{
    const Tables tables = tables_of("perlin");
    double nearest = -1, moment[3][3] = {};
    for (size_t i = 0; i < 32; ++i) {
        const double u[3] = {tables.x[i], tables.y[i], tables.z[i]};
        for (size_t a = 0; a < 3; ++a) {
            for (size_t b = 0; b < 3; ++b) moment[a][b] += u[a] * u[b] / 32;
        }
        for (size_t j = 0; j < i; ++j)
            nearest = std::max(nearest, u[0] * tables.x[j] + u[1] * tables.y[j] + u[2] * tables.z[j]);
    }
    CHECK(std::acos(nearest) * 180 / 3.14159265358979 > 37.3);
    for (size_t a = 0; a < 3; ++a) {
        for (size_t b = 0; b < 3; ++b) CHECK(std::abs(moment[a][b] - (a == b ? 1.0 / 3 : 0.0)) < 1e-15);
    }
}

TEST_CASE("as strong as gradient noise should be, and without bias")
{
    // Root mean squares over all unit tables: .182 and .769 for cubic weights, .191 and .861 for quintic ones. One
    // table of 256 random vectors may stray by 5 percent; perlin's even directions do not.
    const std::vector<Vec3> points = points_within(100, 40'000);
    const auto square = [](const FieldSample& s) { return s.value * s.value; };
    const auto slope = [](const FieldSample& s) {
        return s.gradient[0] * s.gradient[0] + s.gradient[1] * s.gradient[1] + s.gradient[2] * s.gradient[2];
    };
    const Field noise("noise(q)"), perlin("perlin(q)");
    CHECK(std::abs(std::sqrt(mean(noise, points, square)) - 0.182) < 0.009);
    CHECK(std::abs(std::sqrt(mean(noise, points, slope)) - 0.769) < 0.038);
    CHECK(std::abs(std::sqrt(mean(perlin, points, square)) - 0.191) < 0.004);
    CHECK(std::abs(std::sqrt(mean(perlin, points, slope)) - 0.861) < 0.012);
    CHECK(std::abs(mean(noise, points, [](const FieldSample& s) { return s.value; })) < 0.01);
    CHECK(std::abs(mean(perlin, points, [](const FieldSample& s) { return s.value; })) < 0.01);
}

TEST_CASE("axes exchanged give another field: the printed C.2 would not")
{
    const std::vector<Vec3> points = points_within(60, 20'000);
    CHECK(std::abs(correlation(Field("noise(q)"), Field("noise(q.yxz)"), points)) < 0.05);
    CHECK(std::abs(correlation(Field("noise(q)"), Field("noise(q.xzy)"), points)) < 0.05);
    CHECK(std::abs(correlation(Field("perlin(q.xy)"), Field("perlin(q.yx)"), points)) < 0.05);
}

TEST_CASE("seeds give unrelated fields; 0 gives the paper's")
{
    const std::vector<Vec3> points = points_within(60, 20'000);
    for (const std::string name : {"noise", "perlin"}) {
        for (const std::string argument : {"q", "q.xy"}) {
            const auto seeded = [&](const std::string& seed) {
                return Field(name + "(" + argument + ", " + seed + ")");
            };
            CAPTURE(name, argument);
            CHECK(std::abs(correlation(seeded("0"), seeded("1"), points)) < 0.05);
            CHECK(std::abs(correlation(seeded("1"), seeded("2"), points)) < 0.05);
            CHECK(std::abs(correlation(seeded("1"), seeded("-1"), points)) < 0.05);
            CHECK(std::abs(correlation(seeded("0"), seeded("256"), points)) < 0.05);
            const Field plain(name + "(" + argument + ")"), zero = seeded("0");
            for (const Vec3& q : points_within(10, 50)) CHECK(plain(q).value == zero(q).value);
        }
    }
}

TEST_CASE("whole points are zeros, the period is 256, far away is as good as near")
{
    for (const std::string name : {"noise", "perlin"}) {
        CAPTURE(name);
        const Field solid(name + "(q)"), plane(name + "(q.xy)");
        for (int i = -3; i < 4; ++i) CHECK(solid({1.0 * i, 7.0 - i, 2.0 * i}).value == 0);
        for (const Vec3& q : points_within(8, 100)) {
            // Coordinates on a grid of 2^-20, so that adding 256 is exact.
            const Vec3 near{std::round(q[0] * 0x1p20) * 0x1p-20, std::round(q[1] * 0x1p20) * 0x1p-20,
                            std::round(q[2] * 0x1p20) * 0x1p-20};
            CHECK(solid(near).value == solid({near[0] + 256, near[1] - 512, near[2] + 1024}).value);
            CHECK(plane(near).value == plane({near[0] - 256, near[1] + 768, near[2]}).value);
        }
        for (const double huge : {1e10, -3e12, 1e100, -1e300}) CHECK(solid.faults({huge, 0.3 * huge, -huge}) == 0);
    }
}

TEST_CASE("periodic noises close after their periods, and are the noise itself in between")
{
    for (const std::string name : {"noise", "perlin"}) {
        CAPTURE(name);
        const Field plain(name + "(q, 5)"), solid(name + "_periodic(q, 3, 5, 0, 5)"),
            flat(name + "_periodic(q.xy, 4, 1)"), flat_plain(name + "(q.xy)");
        for (const Vec3& q : points_within(20, 200)) {
            const FieldSample here = solid(q), there = solid({q[0] + 3, q[1] - 10, q[2]});
            CHECK(std::abs(here.value - there.value) < 1e-13);
            for (size_t a = 0; a < 3; ++a) CHECK(std::abs(here.gradient[a] - there.gradient[a]) < 1e-12);
            CHECK(std::abs(flat(q).value - flat({q[0] - 8, q[1] + 7, 0}).value) < 1e-13);
            const Vec3 inside{2 * std::abs(q[0]) / 20, 4 * std::abs(q[1]) / 20, q[2]};
            CHECK(solid(inside).value == plain(inside).value);
        }
        // a period of 1 leaves one vector per row: equal values at the faces, and still a gradient along them
        CHECK(std::abs(flat({0.3, 0.4, 0}).value - flat_plain({0.3, 0.4, 0}).value) > 1e-3);
    }
}
