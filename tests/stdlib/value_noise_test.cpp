// value_noise against sums over corners that are worked out here, and its facts against suprema over all corner
// heights.
#include "tests/stdlib/facts.h"
#include "tests/stdlib/pcg4d.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel;
using namespace haptel::test;

namespace {

// 6 t^5 - 15 t^4 + 10 t^3 and its first two derivatives; of the corner at 1, and with 1 - t of that at 0.
struct CornerWeight {
    double value, first, second;
};
CornerWeight weight(double t)
{
    return {t * t * t * (10 + t * (6 * t - 15)), 30 * t * t * (t - 1) * (t - 1), 60 * t * (1 + t * (2 * t - 3))};
}

// The sum of the corners' heights times the products of their weights.
double expected_height(const Vec3& q, bool in_space, int seed)
{
    double sum = 0;
    for (int corner = 0; corner < (in_space ? 8 : 4); ++corner) {
        int32_t at[3] = {};
        double product = 1;
        for (size_t a = 0; a < (in_space ? 3 : 2); ++a) {
            const int far = corner >> a & 1;
            at[a] = static_cast<int32_t>(std::floor(q[a])) + far;
            const double way = std::fabs(q[a] - at[a]);
            product *= weight(1 - way).value;
        }
        const Four bits = in_space ? pcg4d(at[0], at[1], at[2], seed) : pcg4d(at[0], at[1], seed, 0);
        sum += product * (2 * unit_of(bits[0]) - 1);
    }
    return sum;
}

} // namespace

TEST_CASE("value_noise is the weighted sum of its corners' heights")
{
    const Field solid("value_noise(q)"), solid_seed("value_noise(q, 7)"), plane("value_noise(q.xy)"),
        plane_seed("value_noise(q.xy, -7)");
    for (const double size : {5.0, 5000.0})
        for (const Vec3& q : points_within(size, 500)) {
            CHECK(std::fabs(solid(q).value - expected_height(q, true, 0)) < 1e-11);
            CHECK(std::fabs(solid_seed(q).value - expected_height(q, true, 7)) < 1e-11);
            CHECK(std::fabs(plane(q).value - expected_height(q, false, 0)) < 1e-11);
            CHECK(std::fabs(plane_seed(q).value - expected_height(q, false, -7)) < 1e-11);
        }
}

TEST_CASE("value_noise at whole points is 2 hash - 1, and level there")
{
    const Field plane("value_noise(q.xy, 3) - (2.0 * hash(q.xy, 3) - 1.0)"),
        solid("value_noise(q, 3) - (2.0 * hash(q, 3) - 1.0)");
    for (const Vec3& q : points_within(1000, 100)) {
        const Vec3 whole{std::round(q[0]), std::round(q[1]), std::round(q[2])};
        for (const Field* field : {&plane, &solid}) {
            CHECK(std::fabs((*field)(whole).value) < 1e-15);
            CHECK((*field)(whole).gradient == Vec3{});
        }
    }
}

TEST_CASE("the facts of value_noise are the supremum over all corner heights, rounded up, and never exceeded")
{
    for (const size_t dimensions : {2, 3}) {
        // of sum |D w| and sum |DD w| along e over the corners
        const auto largest = [&](bool is_second) {
            return supremum(dimensions, 0, 1, [&](const Vec3& x, const Vec3& e) {
                double sum = 0;
                for (size_t corner = 0; corner < size_t(1) << dimensions; ++corner) {
                    double value = 1, first = 0, second = 0;
                    for (size_t a = 0; a < dimensions; ++a) {
                        const bool far = corner >> a & 1;
                        const CornerWeight w = weight(far ? x[a] : 1 - x[a]);
                        const double along = far ? e[a] : -e[a];
                        second = second * w.value + 2 * first * w.first * along + value * w.second * along * along;
                        first = first * w.value + value * w.first * along;
                        value *= w.value;
                    }
                    sum += std::fabs(is_second ? second : first);
                }
                return sum;
            });
        };
        const std::string type = dimensions == 3 ? "vec3" : "vec2", argument = dimensions == 3 ? "q" : "q.xy";
        const double slope = largest(false), curvature = largest(true);
        for (const std::string seed : {"", "3"}) {
            const std::string call = "value_noise(" + argument + (seed.empty() ? ")" : ", 3)");
            const ir::Facts facts = facts_of("value_noise(" + type + (seed.empty() ? ")" : ",int)"), call);
            CAPTURE(call, slope, curvature);
            CHECK((facts.slope.value() > slope - 1e-9 && *facts.slope < slope * 1.0001));
            CHECK((facts.curvature.value() > curvature - 1e-9 && *facts.curvature < curvature * 1.0001));
            CHECK((facts.value_minimum == -1 && facts.value_maximum == 1));
            check_never_exceeded(call, facts, 50);
        }
    }
}

TEST_CASE("value_noise: seeds are unrelated, and nothing repeats after 256")
{
    const Field zero("value_noise(q.xy)"), same("value_noise(q.xy, 0)"), other("value_noise(q.xy, 1)"),
        away("value_noise(q.xy + 256.0)");
    double square = 0, by_seed = 0, by_place = 0;
    for (const Vec3& q : points_within(1000, 2000)) {
        CHECK(zero(q).value == same(q).value);
        square += zero(q).value * zero(q).value;
        by_seed += zero(q).value * other(q).value;
        by_place += zero(q).value * away(q).value;
    }
    CHECK(std::fabs(by_seed) < 0.12 * square); // 5 / sqrt(2000)
    CHECK(std::fabs(by_place) < 0.12 * square);
}
