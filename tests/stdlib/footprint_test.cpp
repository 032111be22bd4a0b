// footprint_in: the footprint in other coordinates. The truth is the Jacobian worked out by hand.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel::test;

namespace {

constexpr double footprint = 0.25;

void check_near(double found, double expected)
{
    CHECK(std::fabs(found - expected) <= 4e-16 * (1 + std::fabs(expected)));
}

} // namespace

TEST_CASE("footprint_in: scaled coordinates scale the footprint by the Frobenius norm")
{
    check_near(Field("footprint_in(3.0 * q)", {}, footprint)({0.1, 0.2, 0.3}).value, footprint * 3 * std::sqrt(3.0));
    check_near(Field("footprint_in(3.0 * q.xy)", {}, footprint)({0.1, 0.2, 0.3}).value, footprint * 3 * std::sqrt(2.0));
    check_near(Field("footprint_in(3.0 * q.x - 4.0 * q.z)", {}, footprint)({0.1, 0.2, 0.3}).value, footprint * 5);
    check_near(Field("footprint_in(vec2(2.0, 1.0))", {}, footprint)({0.1, 0.2, 0.3}).value, 0);
}

TEST_CASE("footprint_in: the height's gradient holds the second derivatives of the coordinates")
{
    // w = (x^2, x y): |J|^2 = 4 x^2 + y^2 + x^2
    const Field field("footprint_in(vec2(q.x * q.x, q.x * q.y))", {}, footprint);
    for (const Vec3& q : points_within(2, 50)) {
        const double norm = std::sqrt(5 * q[0] * q[0] + q[1] * q[1]);
        const FieldSample made = field(q);
        check_near(made.value, footprint * norm);
        check_near(made.gradient[0], footprint * 5 * q[0] / norm);
        check_near(made.gradient[1], footprint * q[1] / norm);
        CHECK(made.gradient[2] == 0);
    }
}

TEST_CASE("footprint_in: is measured where a function is called, also as an argument and under grad")
{
    const std::string functions = R"(
        float fine(vec2 q) { return q.x * footprint_in(q); }
        float twice(float f(vec2), vec2 q) { return f(2.0 * q); })";
    // twice: 2 x footprint 2 sqrt(2)
    check_near(Field("twice(fine, q.xy)", functions, footprint)({0.5, 0, 0}).value, footprint * 2 * std::sqrt(2.0));
    // d/dx (x footprint_in(q)) = footprint_in(q), q = 3 (x, y)
    check_near(Field("grad(fine)(3.0 * q.xy).x", functions, footprint)({0.5, 0, 0}).value,
               footprint * 3 * std::sqrt(2.0));
}

TEST_CASE("footprint_in: no footprint is none, however steep the coordinates")
{
    CHECK(Field("footprint_in(1.0e300 * 1.0e300 * q)")({0.1, 0.2, 0.3}).value == 0);
}
