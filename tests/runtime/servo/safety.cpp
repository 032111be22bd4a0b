// What keeps a hand safe: limits, the rise of forces, and what is not finite.
#include "runtime/force/force_model.h"
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

} // namespace

TEST_CASE("the force never exceeds the limit and keeps its direction")
{
    Scene scene = bare_scene(plane_mesh(), sine_texture(60e-6, 1e-3));
    scene.servo.force_limit_n = 7;
    const auto touched = shared(std::move(scene));
    for (const double device_max_n : {0.0, 3.3, 50.0}) {
        const double limit_n = device_max_n == 3.3 ? 3.3 : 7.0;
        Renderer renderer(touched, {.force_max_n = device_max_n});
        CHECK(renderer.force_limit_n() == limit_n);
        renderer.tick(at(0.001, 0.002, 1e-3));
        const TickResult deep = renderer.tick(at(0.001, 0.002, -0.1));
        CHECK(glm::length(deep.unlimited_force_n) > 90);
        CHECK(std::abs(glm::length(deep.force_n) - limit_n) < 1e-12);
        CHECK(degrees_between(deep.force_n, deep.unlimited_force_n) < 1e-10);
    }
    std::mt19937 random(2);
    std::normal_distribution<double> part(0, 10);
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec3 force(part(random), part(random), part(random));
        CHECK(glm::length(limited(force, 7)) <= 7);
    }
    const glm::dvec3 huge = limited({1e308, -1e308, 1e308}, 7);
    CHECK(std::abs(glm::length(huge) - 7) < 1e-12);
    CHECK(degrees_between(huge, {1, -1, 1}) < 1e-10);
    CHECK(limited({0, 0, 0}, 7) == glm::dvec3(0));
    CHECK(limited({0, 3, 4}, 5.1) == glm::dvec3(0, 3, 4));
}

TEST_CASE("a pose that is not finite gives zero force and keeps the contact")
{
    Scene scene = bare_scene(plane_mesh(), sine_texture(60e-6, 1e-3));
    scene.objects[0].material = {1000, 1.0, 0.3, 0.2};
    Renderer renderer(shared(std::move(scene)));
    for (int i = 0; i < 50; ++i) renderer.tick(at(0.001, 0.002, 1e-3 - i * 4e-5));
    glm::dvec3 before(0);
    for (int i = 0; i < 200; ++i) before = renderer.tick(at(0.00105, 0.002, -0.96e-3)).force_n;
    REQUIRE(glm::length(before) > 0.5);
    for (const DevicePose& bad : {at(not_a_number, 0, 0), at(0, 0, std::numeric_limits<double>::infinity()),
                                  DevicePose{{0, 0, 0}, {0, not_a_number, 0}}}) {
        const TickResult result = renderer.tick(bad);
        CHECK(result.force_n == glm::dvec3(0));
        CHECK(result.faults == fault_pose_not_finite);
    }
    const TickResult after = renderer.tick(at(0.00105, 0.002, -0.96e-3));
    CHECK(after.faults == 0);
    CHECK(glm::length(after.force_n - before) < 1e-9);
}

TEST_CASE("a pose of absurd size is forgotten like one that is not finite")
{
    constexpr double most = std::numeric_limits<double>::max();
    for (const ProbeKind probe : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus})
        for (const glm::dvec3 tip : {glm::dvec3(0.001, 0.002, most), glm::dvec3(-most, most, 1e300)})
            for (const glm::dvec3 tail : {tip, glm::dvec3(0, 0, 0.1), glm::dvec3(most)}) {
                Scene scene = bare_scene(plane_mesh());
                scene.objects[0].material.damping_n_s_per_m = 1;
                scene.probe = {probe, 0.1, probe == ProbeKind::sphere ? 2e-3 : 0};
                const double radius_m = scene.probe.radius_m;
                Renderer renderer(shared(std::move(scene)));
                const auto hand = [&](double z) {
                    return DevicePose{{0.001, 0.002, z + radius_m}, {0.001, 0.002, z + 0.1}};
                };
                for (int i = 0; i < 200; ++i) renderer.tick(hand(1e-4 - i * 5e-6));
                REQUIRE(renderer.tick(hand(-1e-3)).force_n.z > 0.5);
                renderer.tick({tip, tail}); // its speed overflows
                renderer.tick({glm::dvec3(0.001, 0.002, 0.1), tail});
                TickResult after;
                for (int i = 0; i < 1000; ++i) after = renderer.tick(hand(i < 100 ? 1e-3 : -1e-3));
                CAPTURE(int(probe), tip.x, tail.z);
                CHECK(after.faults == 0);
                CHECK(after.force_n.z > 0.5);
            }
}

TEST_CASE("a texture that breaks its promises stays finite, below its bound, and is told on")
{
    double height_m = 0, slope = 0;
    TextureBinding rogue = lambda_texture(
        [&](const haptel_point&, glm::dvec3& gradient) {
            gradient = {slope, 0, 0};
            return height_m;
        },
        -1e-3, 1e-3);
    Renderer renderer(shared(bare_scene(plane_mesh(), rogue)));
    renderer.tick(at(0.001, 0.002, 1e-3));
    const auto press = [&](double h, double s) {
        height_m = h;
        slope = s;
        return renderer.tick(at(0.001, 0.002, -2e-3));
    };
    CHECK(press(0, 0.1).faults == 0);
    CHECK(press(not_a_number, 0.1).faults == HAPTEL_FAULT_HEIGHT_NOT_FINITE);
    CHECK(press(not_a_number, 0.1).force_n == press(0, 0).force_n);
    CHECK(press(0, not_a_number).faults == HAPTEL_FAULT_GRADIENT_NOT_FINITE);
    CHECK(press(0, not_a_number).force_n == press(0, 0).force_n);
    CHECK(press(5e-3, 0.1).faults == fault_height_above_bound);
    CHECK(press(5e-3, 0.1).force_n == press(1e-3, 0).force_n);
    CHECK(press(1e-3, 1e300).faults == 0); // huge, not infinite: only the limit stands in its way
    CHECK(std::abs(glm::length(press(1e-3, 1e300).force_n) - 100) < 1e-9);
    CHECK(press(1e-3, 1.7e308).faults == fault_force_not_finite);
    CHECK(press(1e-3, 1.7e308).force_n == glm::dvec3(0));
    CHECK(press(-1e308, 0).force_n == glm::dvec3(0));
}

TEST_CASE("forces rise from zero after the start")
{
    Scene scene = bare_scene(plane_mesh());
    scene.servo.force_rise_s = 0.1;
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0, 0, 1e-3));
    for (int tick = 1; tick < 200; ++tick) {
        const TickResult result = renderer.tick(at(0, 0, -1e-3));
        CHECK(std::abs(result.force_n.z - std::min(1.0, tick / 100.0)) < 1e-9);
        CHECK(std::abs(result.unlimited_force_n.z - 1) < 1e-9);
    }
}

TEST_CASE("forces rise from zero after every interruption")
{
    Scene scene = bare_scene(plane_mesh());
    scene.servo.force_rise_s = 0.05;
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0, 0, 1e-3));
    const auto pressed = at(0, 0, -1e-3);
    for (int i = 0; i < 100; ++i) renderer.tick(pressed);
    REQUIRE(std::abs(renderer.tick(pressed).force_n.z - 1) < 1e-9);
    DevicePose back = pressed; // the device was away for 30 periods
    back.periods = 30;
    back.interrupted = true;
    for (const bool away : {true, false}) {
        if (!away) renderer.tick(at(not_a_number, 0, 0));
        const TickResult first = renderer.tick(away ? back : pressed);
        CHECK(first.interrupted);
        CHECK(first.force_n == glm::dvec3(0));
        for (int i = 1; i < 60; ++i) {
            const TickResult result = renderer.tick(pressed);
            CHECK_FALSE(result.interrupted);
            CHECK(std::abs(result.force_n.z - std::min(1.0, i / 50.0)) < 1e-9);
        }
    }
    // Missed deadlines are none: the last force was held meanwhile.
    back.interrupted = false;
    CHECK(std::abs(renderer.tick(back).force_n.z - 1) < 1e-9);
}

TEST_CASE("a probe that cannot go all its way in a tick says so, and only then")
{
    // A ball on the edges of few blades, or of thousands, which no disc around many of them keeps off it.
    for (const bool fits : {true, false}) {
        CAPTURE(fits);
        Mesh blades;
        const uint32_t count = fits ? 100 : 10'000;
        for (uint32_t i = 0; i < count; ++i) {
            const double x = 0.1 * i / count - 0.05;
            for (const glm::dvec3& corner : {glm::dvec3(x, -0.05, 0), glm::dvec3(x, 0.05, 0), glm::dvec3(x, 0, -0.02)})
                blades.positions_m.push_back(corner);
            blades.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        Scene scene = bare_scene(blades);
        scene.probe = {ProbeKind::sphere, 0, 0.02};
        Renderer renderer(shared(std::move(scene)));
        uint32_t faults = renderer.tick(at(-0.02, 0, 0.03)).faults;
        for (int i = 0; i < 300; ++i)
            faults |= renderer.tick(at(-0.02 + (fits ? i * 1e-5 : i % 2 * 0.04), 0, 0.019)).faults;
        CHECK(faults == (fits ? 0u : uint32_t{fault_contact_unfinished}));
    }
}
