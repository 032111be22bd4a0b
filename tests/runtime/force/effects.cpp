// What is felt beside contact, held to closed forms: vibrations, and what all effects have in common.
#include "runtime/render/renderer.h"
#include "runtime/servo/allocation_count.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

constexpr double period_s = 1e-3;

Scene vibrating(const Mesh& mesh, double force_n, double frequency_hz, double reach_m)
{
    Scene scene = bare_scene(mesh);
    scene.objects[0].effects.vibration = {force_n, frequency_hz, {1, 0, 0}};
    scene.objects[0].effects.vibration_reach_m = reach_m;
    return scene;
}

} // namespace

TEST_CASE("a stylus feels by its tip what a point feels, and its grip feels the torque of that")
{
    const auto scene = [](ProbeKind probe) {
        Scene s = magnet_scene(shape("icosphere", 0.1), 1, 0.02);
        s.objects[0].effects.damping_n_s_per_m = 2;
        s.objects[0].effects.damping_reach_m = 0.03;
        Region region;
        region.damping_n_s_per_m = 1;
        s.regions.push_back(region);
        s.probe = {probe, 0.1, 0};
        return shared(std::move(s));
    };
    Renderer point(scene(ProbeKind::point)), stylus(scene(ProbeKind::stylus));
    double largest_n = 0;
    for (int i = 0; i < 1000; ++i) {
        const double t = i * 0.003;
        const glm::dvec3 tip = (0.062 + 0.008 * std::sin(5 * t)) * glm::dvec3(std::cos(t), std::sin(t), 0);
        const glm::dvec3 tail = tip * (1 + 0.1 / glm::length(tip));
        const TickResult a = point.tick({tip, tail}), b = stylus.tick({tip, tail});
        REQUIRE(b.contacts == 0);
        CHECK(glm::distance(a.force_n, b.force_n) < 1e-12);
        CHECK(glm::distance(b.torque_n_m, glm::cross(tip - tail, b.force_n)) < 1e-12); // held at its tail
        largest_n = std::max(largest_n, glm::length(glm::cross(tip - tail, b.force_n)));
    }
    CHECK(largest_n > 0.005);
}

TEST_CASE("a vibration swings in touch with its amplitude and frequency, comes and goes by a ramp")
{
    constexpr double force_n = 0.5, frequency_hz = 80;
    Renderer renderer(shared(vibrating(plane_mesh(), force_n, frequency_hz, 0)));
    double last_n = 0;
    for (int i = 0; i < 600; ++i) {
        const bool touching = i >= 100 && i < 400;
        const glm::dvec3 force = renderer.tick(at(0, 0, touching ? -1e-3 : 1e-3)).force_n;
        const double level = touching  ? std::min(1.0, (i - 99) / 20.0)
                             : i < 100 ? 0
                                       : std::max(0.0, 1 - (i - 399) / 20.0);
        const double wanted_n = level * force_n * std::sin(2 * std::numbers::pi * frequency_hz * i * period_s);
        CHECK(std::fabs(force.x - wanted_n) < 1e-9);
        CHECK(std::fabs(force.z - (touching ? 1 : 0)) < 1e-8);
        CHECK(std::fabs(force.x - last_n) <=
              force_n * (2 * std::numbers::pi * frequency_hz * period_s + period_s / vibration_ramp_s));
        last_n = force.x;
    }
}

TEST_CASE("a vibration is felt within its reach, weaker with the distance, and turns with its object")
{
    Scene scene = vibrating(plane_mesh(), 1, 50, 0.01);
    scene.objects[0].placement.rotation = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}; // x to y
    Renderer renderer(shared(std::move(scene)));
    double largest_n = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 force = renderer.tick(at(0, 0, 0.004)).force_n;
        CHECK(std::fabs(force.x) < 1e-12);
        if (i > 50) largest_n = std::max(largest_n, std::fabs(force.y));
    }
    CHECK(std::fabs(largest_n - 0.6) < 1e-9); // 5 ms to the crest: a tick falls on it
    // Away in one leap: it rings down where the hand is now, and is silent then.
    int sounding = 0;
    for (int i = 0; i < 100; ++i) sounding += renderer.tick(at(0, 0, 0.5)).force_n != glm::dvec3(0);
    CHECK(sounding >= 9);
    CHECK(sounding <= 12);
    CHECK(renderer.skipped().objects > 80);
}

TEST_CASE("effects are within the force limit and rise like all forces")
{
    Scene scene = vibrating(plane_mesh(), 50, 100, 0.01);
    scene.objects[0].effects.magnet = {40, 0.01};
    scene.servo.force_limit_n = 3;
    scene.servo.force_rise_s = 0.1;
    Renderer renderer(shared(std::move(scene)));
    double largest_n = 0;
    for (int i = 0; i < 300; ++i) {
        const TickResult result = renderer.tick(at(0, 0, 0.003));
        const double force_n = glm::length(result.force_n);
        CHECK(force_n <= std::min(3.0, i / 100.0 * glm::length(result.unlimited_force_n)) + 1e-12);
        largest_n = std::max(largest_n, force_n);
    }
    CHECK(std::fabs(largest_n - 3) < 1e-12);
}

TEST_CASE("what acts at a distance wakes its object in time, however the hand comes")
{
    constexpr double force_n = 2, reach_m = 5e-3;
    std::mt19937 random(8);
    std::uniform_real_distribution<double> height(-0.01, 0.3);
    Scene scene = magnet_scene(plane_mesh(), force_n, reach_m);
    for (int i = 1; i < 20; ++i) {
        SceneObject other = scene.objects[0];
        other.placement.position_m = {0, 0, -0.2 * i};
        scene.objects.push_back(other);
    }
    Renderer renderer(shared(std::move(scene)));
    for (int i = 0; i < 2000; ++i) {
        const double z = std::fabs(height(random));
        const double x = z / reach_m;
        const TickResult result = renderer.tick(at(0.01, 0, z));
        CHECK(std::fabs(result.force_n.z + (x < 1 ? 4 * force_n * x * (1 - x) : 0)) < 1e-8);
    }
    CHECK(renderer.skipped().objects > 2000 * 16);
    const uint64_t queries = renderer.work().sweeps;
    for (int i = 0; i < 1000; ++i) renderer.tick(at(1e-5 * i, 0, 0.3));
    CHECK(renderer.work().sweeps <= queries + 10); // out of reach: nobody is asked
}

TEST_CASE("no force is sent before it is small, where the scene waits for that")
{
    constexpr double force_n = 2, reach_m = 0.01, small_n = 0.5;
    Scene scene = magnet_scene(plane_mesh(), force_n, reach_m);
    scene.servo.wait_for_small_force_n = small_n;
    scene.servo.force_rise_s = 0.02;
    Renderer renderer(shared(std::move(scene)));
    const auto pull_n = [&](double z) { return 4 * force_n * z / reach_m * (1 - z / reach_m); };
    const auto waits = [&](double z, bool interrupted = false) {
        DevicePose pose = at(0, 0, z);
        pose.interrupted = interrupted;
        const TickResult result = renderer.tick(pose);
        CHECK(result.waiting);
        CHECK(result.force_n == glm::dvec3(0));
    };
    for (int i = 0; i < 500; ++i) waits(0.005);
    waits(0.009 - 2.5e-3); // 1.82 N
    constexpr double there_m = 0.0095;
    REQUIRE(pull_n(there_m) < small_n);
    for (int i = 0; i < 40; ++i) {
        const TickResult result = renderer.tick(at(0, 0, there_m));
        CHECK_FALSE(result.waiting);
        CHECK(std::fabs(result.force_n.z + std::min(1.0, i / 20.0) * pull_n(there_m)) < 1e-9);
    }
    CHECK(std::fabs(renderer.tick(at(0, 0, 0.005)).force_n.z + 2) < 1e-9); // it waits no more

    // The device was away: what the hand presses meanwhile does not come back before the hand lets go.
    renderer.tick(at(0, 0, -2e-3));
    waits(-2e-3, true);
    for (int i = 0; i < 500; ++i) waits(-2e-3);
    renderer.tick(at(std::nan(""), 0, 0));
    waits(-2e-3);
    CHECK_FALSE(renderer.tick(at(0, 0, -0.4e-3)).waiting);
    for (int i = 0; i < 20; ++i) renderer.tick(at(0, 0, -0.4e-3));
    CHECK(std::fabs(renderer.tick(at(0, 0, -2e-3)).force_n.z - 2) < 1e-8);
}

TEST_CASE("effects allocate nothing in a tick, and twins give the same bits")
{
    const auto scene = [] {
        Scene s = vibrating(shape("torus", 0.1), 0.3, 130, 0.005);
        s.objects[0].effects.magnet = {1, 0.01};
        s.objects[0].effects.damping_n_s_per_m = 2;
        s.objects[0].effects.damping_reach_m = 0.02;
        Region region;
        region.damping_n_s_per_m = 1;
        region.vibration = {0.1, 30, {0, 1, 0}};
        s.regions.push_back(region);
        return shared(std::move(s));
    };
    Renderer a(scene()), b(scene());
    std::mt19937 random(2);
    std::normal_distribution<double> step(0, 2e-4);
    glm::dvec3 tip(0.07, 0, 0);
    int different = 0;
    const uint64_t before = allocations_of_this_thread();
    for (int i = 0; i < 5000; ++i) {
        tip = 0.999 * tip + glm::dvec3(step(random), step(random), step(random));
        different += a.tick({tip, tip}).force_n != b.tick({tip, tip}).force_n;
    }
    CHECK(allocations_of_this_thread() == before);
    CHECK(different == 0);
}
