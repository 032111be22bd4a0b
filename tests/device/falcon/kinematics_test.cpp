#include "device/falcon/falcon_kinematics.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace haptel::device;
using glm::dvec3;

namespace {

// The box that the grip can be moved in.
dvec3 random_place(std::mt19937& random)
{
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    return {between(-0.045, 0.045), between(-0.045, 0.045), between(0.08, 0.17)};
}

// Not near its corners, where an arm and its parallelogram come into line and slopes grow without bound.
dvec3 random_place_within(std::mt19937& random)
{
    return falcon_centre_m + 0.7 * (random_place(random) - falcon_centre_m);
}

// The mechanism as it is built, without any formula for its angles: for an arm at this angle the parallelogram must
// have its length. All in the leg's own axes; `lean` is the part of it out of the plane.
double length_of_parallelogram_m(int leg, const dvec3& place_m, double angle_rad)
{
    constexpr double degree = 3.14159265358979323846 / 180;
    const double turn = (leg == 0 ? 105 : leg == 1 ? -15 : -135) * degree;
    const dvec3 outward(std::cos(turn), std::sin(turn), 0), aside(-std::sin(turn), std::cos(turn), 0), up(0, 0, 1);
    const dvec3 arm_end =
        0.0400 * outward - 0.02309 * aside + 0.060 * (std::cos(angle_rad) * outward + std::sin(angle_rad) * up);
    const dvec3 joint = place_m + 0.01443 * outward - 0.025 * aside;
    const dvec3 rod = joint - arm_end;
    const double lean = glm::dot(rod, aside);
    const double in_plane = std::hypot(glm::dot(rod, outward), rod.z) - 2 * 0.01125;
    return std::hypot(lean, in_plane);
}

} // namespace

TEST_CASE("the angles of the arms close the mechanism: each parallelogram has its length")
{
    std::mt19937 random(1);
    double worst_m = 0;
    int reached = 0;
    for (int i = 0; i < 20000; ++i) {
        const dvec3 place_m = random_place(random);
        const auto angles = falcon_angles(place_m);
        if (!angles) continue;
        ++reached;
        for (int leg = 0; leg < 3; ++leg)
            worst_m = std::max(worst_m, std::abs(length_of_parallelogram_m(leg, place_m, (*angles)[leg]) - 0.1025));
    }
    WARN(reached << " of 20000 places reached; lengths are off by at most " << worst_m << " m");
    CHECK(worst_m < 1e-15);
    CHECK(reached > 19800);
}

TEST_CASE("the place that belongs to angles is found to 1e-9 m, in a few iterations")
{
    std::mt19937 random(2);
    double worst_m = 0;
    int cold_max = 0, warm_max = 0, failed = 0;
    for (int i = 0; i < 20000; ++i) {
        const dvec3 place_m = random_place(random);
        const auto angles = falcon_angles(place_m);
        if (!angles) continue;
        const dvec3 near_m = place_m + 0.0005 * glm::normalize(random_place(random) - falcon_centre_m);
        const auto cold = falcon_place(*angles, falcon_centre_m), warm = falcon_place(*angles, near_m);
        if (!cold || !warm) {
            ++failed;
            continue;
        }
        worst_m = std::max({worst_m, glm::distance(cold->place_m, place_m), glm::distance(warm->place_m, place_m)});
        cold_max = std::max(cold_max, cold->iterations);
        warm_max = std::max(warm_max, warm->iterations);
    }
    WARN("off by at most " << worst_m << " m; iterations at most " << cold_max << " from the centre, " << warm_max
                           << " from 0.5 mm away; " << failed << " failed");
    CHECK(failed == 0);
    CHECK(worst_m < 1e-9);
    CHECK(cold_max <= 8);
    CHECK(warm_max <= 4);
}

TEST_CASE("whatever the encoders tell, the search for a place ends")
{
    std::mt19937 random(3);
    int most = 0, nowhere = 0, wrong = 0;
    for (int i = 0; i < 50000; ++i) {
        const FalconCounts encoders = {static_cast<int16_t>(random()), static_cast<int16_t>(random()),
                                       static_cast<int16_t>(random())};
        const dvec3 angles = falcon_encoder_angles(encoders);
        const auto found = falcon_place(angles, random_place(random));
        if (!found) {
            ++nowhere;
            continue;
        }
        most = std::max(most, found->iterations);
        for (int leg = 0; leg < 3; ++leg)
            wrong += std::abs(length_of_parallelogram_m(leg, found->place_m, angles[leg]) - 0.1025) > 1e-9;
    }
    WARN("at most " << most << " iterations; " << nowhere << " of 50000 belong to no place");
    CHECK(most <= falcon_iterations_max);
    CHECK(wrong == 0);
    CHECK(!falcon_place(dvec3(std::nan("")), falcon_centre_m));
    CHECK(falcon_place(*falcon_angles(falcon_centre_m), dvec3(std::nan(""))));
}

TEST_CASE("gradients of the angles are those of the closed inverse")
{
    std::mt19937 random(4);
    double worst = 0;
    constexpr double step_m = 1e-6;
    for (int i = 0; i < 5000; ++i) {
        const dvec3 place_m = random_place_within(random);
        const auto angles = falcon_angles(place_m);
        if (!angles) continue;
        const auto gradients = falcon_angle_gradients(place_m, *angles);
        REQUIRE(gradients);
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 step(0);
            step[axis] = step_m;
            const auto after = falcon_angles(place_m + step), before = falcon_angles(place_m - step);
            if (!after || !before) continue;
            const dvec3 slope = (*after - *before) / (2 * step_m);
            worst = std::max(worst, glm::length((*gradients)[axis] - slope) / glm::length(slope));
        }
    }
    WARN("relative difference at most " << worst);
    CHECK(worst < 1e-6);
}

TEST_CASE("the work of the torques is the work of the force, whatever small step the grip makes")
{
    std::mt19937 random(5);
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
        const dvec3 place_m = random_place_within(random);
        const auto angles = falcon_angles(place_m);
        if (!angles) continue;
        const dvec3 force_n = 5.0 * glm::normalize(random_place(random) - falcon_centre_m);
        const dvec3 step_m = 1e-6 * glm::normalize(random_place(random) - falcon_centre_m);
        const auto torques = falcon_torques(force_n, place_m, *angles);
        REQUIRE(torques);
        const auto after = falcon_angles(place_m + step_m), before = falcon_angles(place_m - step_m);
        if (!after || !before) continue;
        const double work_j = glm::dot(force_n, 2.0 * step_m);
        worst = std::max(worst, std::abs(glm::dot(*torques, *after - *before) - work_j) / (5.0 * 2e-6));
    }
    WARN("difference at most " << worst << " of force times way");
    CHECK(worst < 1e-6);
}

TEST_CASE("pushing the grip into the device takes the same of all motors, positive counts")
{
    const auto angles = falcon_angles(falcon_centre_m);
    const FalconCounts counts = falcon_motor_counts(*falcon_torques({0, 0, -3}, falcon_centre_m, *angles));
    CHECK(counts[0] > 100);
    CHECK(counts[0] == counts[1]);
    CHECK(counts[0] == counts[2]);
}

TEST_CASE("motors are limited together, so that the force keeps its direction, and never see what is not a number")
{
    std::mt19937 random(6);
    for (int i = 0; i < 2000; ++i) {
        const dvec3 torques_n_m = 100.0 * (random_place(random) - falcon_centre_m);
        const FalconCounts counts = falcon_motor_counts(torques_n_m);
        const dvec3 wanted = -10000.0 * torques_n_m, got(counts[0], counts[1], counts[2]);
        for (const int16_t count : counts) REQUIRE(std::abs(count) <= 4095);
        const double share =
            std::min(1.0, 4095 / std::max({std::abs(wanted.x), std::abs(wanted.y), std::abs(wanted.z)}));
        REQUIRE(glm::length(got - share * wanted) < 1);
    }
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity, 1e308})
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 torques_n_m(0.1);
            torques_n_m[axis] = bad;
            const FalconCounts counts = falcon_motor_counts(torques_n_m);
            for (const int16_t count : counts) REQUIRE(count == 0);
        }
}

TEST_CASE("encoder counts of a homed arm begin at 35 degrees and move the grip by 0.03 to 0.06 mm each")
{
    CHECK(falcon_encoder_angles({0, 0, 0}).x * 180 / 3.14159265358979323846 == 35);
    CHECK(std::abs(falcon_encoder_angles({1000, 0, 0}).x * 180 / 3.14159265358979323846 - (35 + 36.4347)) < 1e-3);
    std::mt19937 random(8);
    double least_m = 1, most_m = 0;
    for (int i = 0; i < 5000; ++i) {
        const dvec3 place_m = random_place_within(random);
        const auto angles = falcon_angles(place_m);
        if (!angles) continue;
        for (int arm = 0; arm < 3; ++arm) {
            dvec3 turned = *angles;
            turned[arm] += falcon_rad_per_count;
            const auto moved = falcon_place(turned, place_m);
            if (!moved) continue;
            least_m = std::min(least_m, glm::distance(moved->place_m, place_m));
            most_m = std::max(most_m, glm::distance(moved->place_m, place_m));
        }
    }
    WARN("one count is " << least_m << " to " << most_m << " m");
    CHECK(least_m > 0.025e-3);
    CHECK(most_m < 0.06e-3);
}
