#include "device/hand.h"
#include "tests/device/surfaces.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using namespace haptel::device;

namespace {

void run(Hand& hand, double seconds)
{
    for (int i = 0; i < std::lround(seconds / period_s); ++i) hand.advance();
}

} // namespace

TEST_CASE("a hand presses against the facet normal with the force asked for")
{
    Hand hand({}, resting(), 1.5, period_s);
    run(hand, 2);
    CHECK(glm::distance(hand.push_n(1), glm::dvec3(0, 0, -1.5)) < 1e-12);
    CHECK(glm::length(hand.aim_m(1)) < 1e-12);
}

TEST_CASE("the push follows a turning normal as a first-order low-pass at 20 Hz")
{
    // The normal turns from z to x when the hand has long settled, at 2 s.
    int calls = 0;
    const auto turning = [&calls](double x, double y) {
        const bool turned = ++calls > 2000 + 1; // one call is the constructor's
        return haptel::runtime::SurfaceHit{{x, y, 0}, turned ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1)};
    };
    Hand hand({}, Stroke([](double) { return CurvePoint{}; }, turning, {}), 1, period_s);
    run(hand, 2);
    for (int tick = 1; tick <= 50; ++tick) {
        hand.advance();
        const double left = std::exp(-2 * std::numbers::pi * 20 * tick * period_s);
        REQUIRE(glm::distance(hand.push_n(1), glm::dvec3(left - 1, 0, -left)) < 1e-9);
    }
}

TEST_CASE("the aim never moves faster than a fast stroke, even where the surface jumps")
{
    int calls = 0;
    const auto cliff = [&calls](double x, double y) {
        return haptel::runtime::SurfaceHit{{x, y, ++calls > 1000 ? 0.05 : 0.0}, {0, 0, 1}};
    };
    Hand hand({}, Stroke([](double) { return CurvePoint{}; }, cliff, {}), 1, period_s);
    for (int i = 0; i < 2000; ++i) {
        hand.advance();
        REQUIRE(glm::length(hand.aim_velocity_m_per_s()) <= hand_speed_max_m_per_s * (1 + 1e-12));
    }
    CHECK(std::abs(hand.aim_m(1).z - 0.05) < 1e-6);
}

TEST_CASE("within a period aim and push go straight from one value to the next")
{
    Hand hand({}, resting(0.3), 1, period_s);
    run(hand, 0.25); // half way down
    const glm::dvec3 from = hand.aim_m(1);
    hand.advance();
    CHECK(hand.aim_m(0) == from);
    CHECK(glm::distance(hand.aim_m(0.5), (hand.aim_m(0) + hand.aim_m(1)) / 2.0) < 1e-15);
    CHECK(glm::distance(hand.aim_velocity_m_per_s() * period_s, hand.aim_m(1) - hand.aim_m(0)) < 1e-15);
}
