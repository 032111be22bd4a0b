// Facts as they are measured, of functions whose range, slope, curvature and class are known in closed form.
#include "jit/check/measure_facts.h"
#include "tests/jit/codegen/samples.h"

#include <cmath>
#include <numbers>

using namespace haptel;

namespace {

struct Known {
    const char* height; // metres, of p in metres within -4 .. 4
    double low, high, slope, curvature;
    uint32_t continuity;
};

constexpr double pi = std::numbers::pi;

jit::MeasuredFacts measured(const std::string& height)
{
    const auto program = test::compiled("texture t() { vec3 q = p / 1m; return 1m * (" + height + "); }");
    const auto bound = jit::make_binding(program, "", test::request_over(8), jit::For::figures);
    REQUIRE(bound.binding);
    return jit::measure_facts(*bound.binding, {{-4, -4, -4}, {4, 4, 4}}, 4000);
}

} // namespace

TEST_CASE("measured facts are those of the closed form")
{
    const Known all[] = {
        {"sin(q.x)", -1, 1, 1, 1, HAPTEL_CONTINUITY_C1},
        {"sinturn(q.x)", -1, 1, 2 * pi, 4 * pi * pi, HAPTEL_CONTINUITY_C1},
        // Of the sum of two waves across each other the gradients add as lengths, and so do not the curvatures.
        {"sin(3.0 * q.x) + sin(3.0 * q.y)", -2, 2, 3 * std::numbers::sqrt2, 9, HAPTEL_CONTINUITY_C1},
        {"2.5 + 0.5 * q.x - q.z", -3.5, 8.5, std::sqrt(1.25), 0, HAPTEL_CONTINUITY_C1},
        // Eigenvalues 2 and -2, along the diagonals.
        {"2.0 * q.x * q.y", -32, 32, 8 * std::numbers::sqrt2, 2, HAPTEL_CONTINUITY_C1},
        {"exp(-dot(q, q))", std::exp(-48.0), 1, std::sqrt(2 / std::numbers::e), 2, HAPTEL_CONTINUITY_C1},
        {"abs(sin(q.x))", 0, 1, 1, 1, HAPTEL_CONTINUITY_C0},
        {"floor(q.x) + sin(q.y)", -5, 5, 1, 1, HAPTEL_CONTINUITY_JUMP},
        {"7.0", 7, 7, 0, 0, HAPTEL_CONTINUITY_C1},
    };
    for (const Known& known : all) {
        CAPTURE(known.height);
        const jit::MeasuredFacts found = measured(known.height);
        CHECK(std::abs(found.value_maximum - known.high) <= 1e-9 * (1 + std::abs(known.high)));
        CHECK(std::abs(found.value_minimum - known.low) <= 1e-9 * (1 + std::abs(known.low)));
        REQUIRE((found.slope && found.curvature));
        CHECK(std::abs(*found.slope - known.slope) <= 1e-8 * known.slope);
        // Differences over 8e-6 leave some 1e-9 of it by the fourth derivative, and 1e-10 by rounding.
        CHECK(std::abs(*found.curvature - known.curvature) <= 1e-7 * (1 + known.curvature));
        CHECK(found.continuity == known.continuity);
        CHECK(found.faulty == 0);
    }
}

TEST_CASE("what grows without end has no figure, and what is not finite is left out")
{
    const jit::MeasuredFacts root = measured("sqrt(abs(q.x))");
    CHECK(!root.slope);
    CHECK(std::abs(root.value_maximum - 2) < 1e-9);
    CHECK(root.value_minimum >= 0);
    const jit::MeasuredFacts half = measured("sqrt(q.x) * 0.0 + q.x");
    CHECK(std::abs(half.faulty - 0.5) < 0.04); // of 4000 places a share of a half is off by 0.008, and not by 5 times
    CHECK(half.value_minimum >= 0);
    CHECK(measured("log(-1.0 - abs(q.x))").faulty == 1);
}
