#include "device/falcon/falcon_place_filter.h"
#include "tests/device/falcon/falcon_truth.h"
#include "tests/support/catch.h"

using namespace haptel::device;
using glm::dvec3;

namespace {

constexpr int64_t tick_ns = 1'000'000;

} // namespace

// Each bit of each encoder, at many places: small errors are the hand's, large ones are not believed.
TEST_CASE("one flipped bit of a reply moves the hand by less than a fast hand moves itself")
{
    double farthest_m = 0;
    int refused = 0;
    for (double x_m = -0.03; x_m <= 0.03; x_m += 0.005)
        for (int arm = 0; arm < 3; ++arm)
            for (int bit = 0; bit < 16; ++bit) {
                const dvec3 true_m(x_m, 0.01, 0.12);
                auto encoders = encoders_at(true_m);
                FalconPlaceFilter filter;
                REQUIRE(filter.add(true_m, 0) == Believed::yes);
                auto& wrong = encoders[static_cast<std::size_t>(arm)];
                wrong = static_cast<int16_t>(wrong ^ (1 << bit));
                const auto found = falcon_place(falcon_encoder_angles(FalconCounts{static_cast<int16_t>(encoders[0]),
                                                                                   static_cast<int16_t>(encoders[1]),
                                                                                   static_cast<int16_t>(encoders[2])}),
                                                true_m);
                if (found) refused += filter.add(found->place_m, tick_ns) == Believed::no;
                farthest_m = std::max(farthest_m, glm::distance(filter.place_m(), true_m));
                REQUIRE(filter.add(true_m, 2 * tick_ns) != Believed::no);
            }
    WARN(refused << " refused; the farthest that was believed is " << farthest_m << " m away");
    CHECK(refused > 100);
    CHECK(farthest_m < 0.008);
}

TEST_CASE("a place far away is believed when the next reply tells it too, and said to be a jump")
{
    FalconPlaceFilter filter;
    CHECK(!filter.has_place());
    CHECK(filter.add({0.04, 0, 0.125}, 0) == Believed::yes); // the first
    CHECK(filter.add({-0.04, 0, 0.125}, tick_ns) == Believed::no);
    CHECK(filter.place_m().x == 0.04);
    CHECK(filter.time_ns() == 0);
    CHECK(filter.add({0.04, 0, 0.125}, 2 * tick_ns) == Believed::yes); // it was wrong
    CHECK(filter.add({-0.04, 0, 0.125}, 3 * tick_ns) == Believed::no);
    CHECK(filter.add({0, 0.04, 0.125}, 4 * tick_ns) == Believed::no); // so is this: the two differ
    CHECK(filter.add({0.001, 0.04, 0.125}, 5 * tick_ns) == Believed::after_a_jump);
    CHECK(filter.place_m().y == 0.04);
    filter.forget();
    CHECK(filter.add({-0.04, 0, 0.125}, 6 * tick_ns) == Believed::yes);
}

TEST_CASE("a hand as fast as hands can be is always believed")
{
    FalconPlaceFilter filter;
    for (int tick = 0; tick < 20; ++tick)
        CHECK(filter.add({-0.04 + 0.004 * tick, 0, 0.125}, tick * tick_ns) == Believed::yes); // 4 m/s
}
