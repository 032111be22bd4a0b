// simplex against its definition: a sum over all corners of its lattice within reach, without simplices and without an
// order of coordinates, in long double. Its facts against suprema over all tables of unit vectors.
#include "tests/stdlib/facts.h"
#include "tests/stdlib/pcg4d.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel;
using namespace haptel::test;

namespace {

// How far a whole point is moved along (1, 1 ..) for each unit of the sum of its coordinates, to be a corner.
long double unskew(size_t dimensions)
{
    return (1 - 1 / std::sqrt(static_cast<long double>(dimensions + 1))) / static_cast<long double>(dimensions);
}

double expected_simplex(const Vec3& q, size_t dimensions, int seed)
{
    static const std::vector<double> directions[] = {library_table("perlin_gx"), library_table("perlin_gy"),
                                                     library_table("perlin_gz"), library_table("perlin_plane_gx"),
                                                     library_table("perlin_plane_gy")};
    const long double move = unskew(dimensions);
    long double sum_of_place = 0;
    for (size_t a = 0; a < dimensions; ++a) sum_of_place += q[a];
    // of the corner that is at q: whole points c with c - move sum(c) = q, sum(c) = sum(q) / (1 - n move)
    const long double skew = move * sum_of_place / (1 - static_cast<long double>(dimensions) * move);
    long double sum = 0;
    const int deep = dimensions == 3 ? 3 : 0;
    for (int di = -3; di <= 3; ++di)
        for (int dj = -3; dj <= 3; ++dj)
            for (int dk = -deep; dk <= deep; ++dk) {
                const long double c[3] = {std::round(q[0] + skew) + di, std::round(q[1] + skew) + dj,
                                          dimensions == 3 ? std::round(q[2] + skew) + dk : 0};
                long double square = 0, d[3];
                for (size_t a = 0; a < dimensions; ++a) {
                    d[a] = q[a] - (c[a] - move * (c[0] + c[1] + c[2]));
                    square += d[a] * d[a];
                }
                if (square >= 0.5L) continue;
                const auto whole = [&](size_t a) { return static_cast<int32_t>(c[a]); };
                const Four bits =
                    dimensions == 3 ? pcg4d(whole(0), whole(1), whole(2), seed) : pcg4d(whole(0), whole(1), seed, 0);
                long double slope = 0;
                for (size_t a = 0; a < dimensions; ++a)
                    slope += directions[(dimensions == 3 ? 0 : 3) + a][bits[0] >> 27] * d[a];
                sum += std::pow(0.5L - square, 4) * slope;
            }
    return static_cast<double>(sum * (dimensions == 3 ? 107.653485L : 99.2043345L));
}

// Of one corner's part along e, for the worst vector there: 0 the value, 1 the slope, 2 the second derivative.
double largest_part(const Vec3& d, const Vec3& e, size_t dimensions, int order)
{
    double square = 0, along = 0;
    for (size_t a = 0; a < dimensions; ++a) {
        square += d[a] * d[a];
        along += d[a] * e[a];
    }
    const double t = 0.5 - square;
    if (t <= 0) return 0;
    const double k = t * t * t * t, k1 = -8 * t * t * t * along, k2 = 48 * t * t * along * along - 8 * t * t * t;
    double length = 0;
    for (size_t a = 0; a < dimensions; ++a) {
        const double part = order == 0 ? k * d[a] : order == 1 ? k * e[a] + k1 * d[a] : 2 * k1 * e[a] + k2 * d[a];
        length += part * part;
    }
    return std::sqrt(length);
}

double largest(size_t dimensions, int order)
{
    const double move = static_cast<double>(unskew(dimensions));
    std::vector<Vec3> corners; // all that reach into the lattice's cell round 0, which is within 0.56 of it
    for (int i = -4; i <= 4; ++i)
        for (int j = -4; j <= 4; ++j)
            for (int k = dimensions == 3 ? -4 : 0; k <= (dimensions == 3 ? 4 : 0); ++k) {
                const double shift = move * (i + j + k);
                const Vec3 corner{i - shift, j - shift, dimensions == 3 ? k - shift : 0};
                if (std::hypot(corner[0], corner[1], corner[2]) < 1.68) corners.push_back(corner);
            }
    return supremum(dimensions, -0.56, 0.56, [&](const Vec3& x, const Vec3& e) {
        double sum = 0;
        for (const Vec3& c : corners)
            sum += largest_part({x[0] - c[0], x[1] - c[1], x[2] - c[2]}, e, dimensions, order);
        return sum;
    });
}

} // namespace

TEST_CASE("simplex is the sum over the corners of its lattice, near and far")
{
    const Field solid("simplex(q)"), solid_seed("simplex(q, 7)"), plane("simplex(q.xy)"),
        plane_seed("simplex(q.xy, -7)");
    for (const double size : {5.0, 5000.0, 1e6}) {
        // of the twin, which takes a place of so many digits apart: long double has 11 bits more than double
        const double rounding = 1e-13 + size * 1e-17;
        for (const Vec3& q : points_within(size, 400)) {
            CHECK(std::fabs(solid(q).value - expected_simplex(q, 3, 0)) < rounding);
            CHECK(std::fabs(solid_seed(q).value - expected_simplex(q, 3, 7)) < rounding);
            CHECK(std::fabs(plane(q).value - expected_simplex(q, 2, 0)) < rounding);
            CHECK(std::fabs(plane_seed(q).value - expected_simplex(q, 2, -7)) < rounding);
        }
    }
}

TEST_CASE("simplex where coordinates are equal, along the edges of simplices")
{
    const Field solid("simplex(q)"), plane("simplex(q.xy)");
    for (const Vec3& q : points_within(5, 300)) {
        for (const Vec3& equal : {Vec3{q[0], q[0], q[0]}, Vec3{q[0], q[0], q[2]}, Vec3{q[0], q[2], q[2]},
                                  Vec3{q[0], q[2], q[0]}, Vec3{std::round(q[0]), std::round(q[1]), std::round(q[2])}}) {
            CHECK(std::fabs(solid(equal).value - expected_simplex(equal, 3, 0)) < 1e-13);
            CHECK(std::fabs(plane(equal).value - expected_simplex(equal, 2, 0)) < 1e-13);
        }
    }
}

TEST_CASE("the facts of simplex are the supremum over all unit tables, rounded up, and never exceeded")
{
    for (const size_t dimensions : {2, 3}) {
        const double scale = dimensions == 3 ? 107.653485 : 99.2043345;
        const double value = scale * largest(dimensions, 0), slope = scale * largest(dimensions, 1),
                     curvature = scale * largest(dimensions, 2);
        const std::string type = dimensions == 3 ? "vec3" : "vec2", argument = dimensions == 3 ? "q" : "q.xy";
        for (const std::string seed : {"", "3"}) {
            const std::string call = "simplex(" + argument + (seed.empty() ? ")" : ", 3)");
            const ir::Facts facts = facts_of("simplex(" + type + (seed.empty() ? ")" : ",int)"), call);
            const auto just_above = [](double fact, double truth) { return fact > truth && fact < truth * 1.0001; };
            CAPTURE(call, value, slope, curvature);
            CHECK(just_above(facts.value_maximum.value(), value));
            CHECK(facts.value_minimum == -1);
            CHECK(just_above(facts.slope.value(), slope));
            CHECK(just_above(facts.curvature.value(), curvature));
            CHECK(facts.continuity == ir::Continuity::c2);
            check_never_exceeded(call, facts, 50);
        }
    }
}

TEST_CASE("simplex: seeds are unrelated, and heights come near to what is stated")
{
    const Field zero("simplex(q.xy)"), same("simplex(q.xy, 0)"), other("simplex(q.xy, 1)"), solid("simplex(q)");
    double square = 0, by_seed = 0, plane_most = 0, solid_most = 0;
    for (const Vec3& q : points_within(1000, 20'000)) {
        CHECK(zero(q).value == same(q).value);
        square += zero(q).value * zero(q).value;
        by_seed += zero(q).value * other(q).value;
        plane_most = std::max(plane_most, std::fabs(zero(q).value));
        solid_most = std::max(solid_most, std::fabs(solid(q).value));
    }
    CHECK(std::fabs(by_seed) < 0.036 * square); // 5 / sqrt(20 000)
    CHECK(plane_most > 0.9);
    CHECK(solid_most > 0.75);
}
