// Force and torque of a stylus as the renderer sends them.
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <cmath>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

// A box of 10 cm, its upper right edge along y at (0.05, y, 0.05).
Scene box_scene(double grip_m = 0.15)
{
    Mesh box = make_box();
    scale_to_size(box, 0.1);
    Scene scene = bare_scene(box);
    scene.probe.kind = ProbeKind::stylus;
    scene.probe.grip_m = grip_m;
    return scene;
}

// A stylus across that edge, the edge at a share of it, so far below that the edge is deep in it.
DevicePose across(double share, double depth_m, double length_m = 0.15)
{
    const dvec3 normal = glm::normalize(dvec3(1, 0, 1)), along = glm::normalize(dvec3(1, 0, -1));
    const dvec3 at = dvec3(0.05, 0.01, 0.05) - depth_m * normal;
    return {at - share * length_m * along, at + (1 - share) * length_m * along};
}

TickResult felt(Renderer& renderer, const DevicePose& pose)
{
    const dvec3 above = 0.05 * glm::normalize(dvec3(1, 0, 1));
    TickResult result;
    for (int i = 0; i <= 20; ++i) {
        DevicePose there = pose;
        there.tip_m += (1 - i / 20.0) * above;
        there.tail_m += (1 - i / 20.0) * above;
        result = renderer.tick(there);
    }
    return result;
}

} // namespace

TEST_CASE("a stylus on an edge is felt with the stiffness over (1-s)^2 + s^2, and turns about its grip by its lever")
{
    const dvec3 normal = glm::normalize(dvec3(1, 0, 1));
    for (const double share : {0.3, 0.5, 0.6})
        for (const double grip_m : {0.0, 0.05, 0.15}) {
            Renderer renderer(shared(box_scene(grip_m)));
            const double depth_m = 1e-6; // so shallow that the stylus hardly turns
            const DevicePose pose = across(share, depth_m);
            const TickResult result = felt(renderer, pose);
            CAPTURE(share, grip_m);
            const double push_n = spring_n_per_m * depth_m / ((1 - share) * (1 - share) + share * share);
            CHECK(glm::length(result.force_n - push_n * normal) < 1e-4 * push_n);
            // The edge is (share * 0.15 - grip) further along the stylus than the hand: force times lever, about -y.
            const dvec3 torque = glm::cross((share * 0.15 - grip_m) * glm::normalize(dvec3(1, 0, -1)), push_n * normal);
            CHECK(glm::length(result.torque_n_m - torque) < 1e-4 * 0.15 * push_n);
            CHECK(glm::distance(result.grip_m, pose.tip_m + grip_m * glm::normalize(dvec3(1, 0, -1))) < 1e-12);
            CHECK(result.contacts == 1);
        }
}

TEST_CASE("a tip alone turns a stylus about its grip, and the force is that of a point")
{
    Scene stylus = box_scene(), point = box_scene();
    point.probe = {};
    Renderer with_shaft(shared(std::move(stylus))), as_point(shared(std::move(point)));
    for (int i = 0; i <= 100; ++i) {
        const dvec3 tip(1e-4 * i, 2e-4 * i, 0.06 - 2e-4 * i);
        const DevicePose pose{tip, tip + dvec3(0.09, 0, 0.12)};
        const TickResult result = with_shaft.tick(pose);
        REQUIRE(result.force_n == as_point.tick(pose).force_n);
        REQUIRE(glm::distance(result.torque_n_m, glm::cross(dvec3(-0.09, 0, -0.12), result.force_n)) < 1e-15);
    }
}

TEST_CASE("torque is limited along with the force, by the same scale")
{
    Scene scene = box_scene();
    scene.servo.force_limit_n = 2;
    Renderer renderer(shared(std::move(scene)));
    const TickResult result = felt(renderer, across(0.4, 5e-3));
    CHECK(glm::length(result.unlimited_force_n) > 5);
    CHECK(std::fabs(glm::length(result.force_n) - 2) < 1e-12);
    const double scale = 2 / glm::length(result.unlimited_force_n);
    CHECK(glm::distance(result.torque_n_m, scale * result.unlimited_torque_n_m) < 1e-12);
}

TEST_CASE("what turns a stylus without pushing it is limited by its own lever")
{
    // Two boxes hold it from opposite sides: their forces cancel, their torques add up.
    Scene scene = box_scene(0.075);
    scene.servo.force_limit_n = 3;
    scene.objects.push_back(scene.objects[0]);
    scene.objects[0].placement.position_m = {-0.1, 0, -0.05}; // its top is z = 0, its right side x = -0.05
    scene.objects[1].placement.position_m = {0.1, 0, 0.05};   // its bottom is z = 0, its left side x = 0.05
    Renderer renderer(shared(std::move(scene)));
    TickResult result;
    for (int i = 0; i <= 40; ++i) { // through the gap between them, turned into both
        const double angle = 0.5 * i / 40;
        const dvec3 along(std::cos(angle), 0, std::sin(angle));
        result = renderer.tick({-0.075 * along, 0.075 * along});
    }
    CHECK(result.contacts == 2);
    CHECK(glm::length(result.unlimited_force_n) < 1e-6);
    CHECK(glm::length(result.unlimited_torque_n_m) > 3 * 0.075);
    CHECK(std::fabs(glm::length(result.torque_n_m) - 3 * 0.075) < 1e-9);
    CHECK(glm::length(result.force_n) < 1e-6);
}

TEST_CASE("a side contact is damped where it touches, and not textured")
{
    Scene scene = box_scene();
    scene.objects[0].material.damping_n_s_per_m = 5;
    Renderer renderer(shared(std::move(scene)));
    const DevicePose rest = across(0.5, 2e-3);
    felt(renderer, rest);
    for (int i = 0; i < 200; ++i) renderer.tick(rest);
    const dvec3 still = renderer.tick(rest).force_n, normal = glm::normalize(dvec3(1, 0, 1));
    // Turning about the middle moves its ends, and not the place that touches.
    DevicePose turned = rest, sunk = rest;
    turned.tip_m -= 1e-5 * normal;
    turned.tail_m += 1e-5 * normal;
    CHECK(glm::distance(renderer.tick(turned).force_n, still) < 1e-3);
    for (int i = 0; i < 200; ++i) renderer.tick(rest);
    sunk.tip_m -= 1e-5 * normal;
    sunk.tail_m -= 1e-5 * normal;
    CHECK(glm::dot(renderer.tick(sunk).force_n - still, normal) >
          0.02 + 5e-3); // 2 k 1e-5, and 5 N s/m of 0.01 m/s filtered
}

TEST_CASE("a stylus whose pose is no number gives no torque, and none is ever infinite")
{
    Renderer renderer(shared(box_scene()));
    const DevicePose pose = across(0.5, 5e-3);
    CHECK(glm::length(felt(renderer, pose).torque_n_m) > 0.1);
    for (const DevicePose& bad : {DevicePose{{NAN, 0, 0}, pose.tail_m}, DevicePose{pose.tip_m, {0, INFINITY, 0}}}) {
        const TickResult result = renderer.tick(bad);
        CHECK(result.torque_n_m == dvec3(0));
        CHECK(result.force_n == dvec3(0));
    }
    for (const double far_m : {1.0, 1e4, 1e150, 1e300}) {
        const TickResult result = renderer.tick({pose.tip_m + dvec3(far_m), pose.tail_m - dvec3(far_m)});
        CHECK(finite(result.torque_n_m));
        CHECK(finite(result.force_n));
        CHECK(glm::length(result.force_n) <= renderer.force_limit_n() * (1 + 1e-12));
    }
}
