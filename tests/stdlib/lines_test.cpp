// The search for jumps against fields whose jumps are known.
#include "tests/stdlib/lines.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel::test;

TEST_CASE("jumps are found along lines, and their size")
{
    const Jumps steps = jumps_along_lines(Field("0.25 * floor(q.x)"), 5, 50);
    CHECK(steps.value == 0.25);
    const Jumps kinks = jumps_along_lines(Field("abs(q.x - 0.3 * q.y)"), 2, 50);
    CHECK(std::fabs(kinks.gradient - 2 * std::hypot(1, 0.3)) < 1e-12);
    CHECK(kinks.value < 1e-10);
}
