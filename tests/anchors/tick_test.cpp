// What a servo may rely on: a tick that survives a bad pose, allocates nothing, is timed, and shares its scene.
#include "runtime/render/renderer.h"
#include "runtime/servo/allocation_count.h"
#include "runtime/servo/servo_thread.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr ProbeSettings every_probe[] = {
    {ProbeKind::point, 0, 0}, {ProbeKind::sphere, 0, 5e-3}, {ProbeKind::stylus, 0.1, 0}};

// A textured plate with friction and damping, a ball beside it, one that moves.
std::shared_ptr<const Scene> scene_of_everything(const ProbeSettings& probe)
{
    Scene scene = bare_scene(plane_mesh(0.1, 16), sine_texture(60e-6, 1e-3));
    Mesh ball = make_icosphere(4);
    scale_to_size(ball, 0.02);
    for (const double x : {0.02, -0.02}) {
        scene.objects.push_back(bare_scene(ball, sine_texture(60e-6, 1e-3)).objects[0]);
        scene.objects.back().placement.position_m = {x, 0, 0.005};
    }
    scene.objects.back().motion =
        std::make_shared<SteadyMotion>(scene.objects.back().placement, SteadyMotion::Figures{{0, 0, 3}, 1.0, {}, 0});
    for (SceneObject& object : scene.objects) object.material = {1000, 1.0, 0.3, 0.2};
    scene.probe = probe;
    return shared(std::move(scene));
}

// Strokes over all of it, pressing and lifting.
DevicePose stroke(int tick, const ProbeSettings& probe)
{
    const double t = tick * 1e-3;
    const dvec3 tip(0.035 * std::sin(5 * t), 0.01 * std::cos(3 * t),
                    probe.radius_m + 1e-3 - 2e-3 * std::sin(7 * t) + 0.01 * std::max(0.0, std::sin(0.9 * t)));
    return {tip, tip + dvec3(0, 0, 0.1)};
}

std::vector<dvec3> forces(const std::shared_ptr<const Scene>& scene, int ticks)
{
    Renderer renderer(scene);
    std::vector<dvec3> all;
    for (int i = 0; i < ticks; ++i) all.push_back(renderer.tick(stroke(i, scene->probe)).force_n);
    return all;
}

} // namespace

TEST_CASE("anchors row 7: after a pose that is no number the wall is felt on the side where it was")
{
    for (const ProbeSettings& probe : every_probe)
        for (const double side : {1.0, -1.0}) // the plate is thin: it has two
            for (const int bad : {0, 1, 2}) {
                CAPTURE(int(probe.kind), side, bad);
                Scene scene = bare_scene(plane_mesh(0.1, 5));
                scene.objects[0].material = {1000, 0, 0.3, 0.2};
                scene.probe = probe;
                Renderer renderer(shared(std::move(scene)));
                const auto pose = [&](double depth_m) {
                    const double z = side * (probe.radius_m - depth_m);
                    return DevicePose{{0.011, 0.007, z}, {0.011, 0.007, z + side * 0.1}};
                };
                for (int i = 0; i < 100; ++i) renderer.tick(pose(-1e-3 + 2e-5 * i));
                const dvec3 before = renderer.tick(pose(1e-3)).force_n;
                CHECK(glm::length(before - dvec3(0, 0, side)) < 1e-8);
                for (int ticks = 0; ticks < 3; ++ticks) {
                    DevicePose none = pose(1e-3);
                    (bad == 0 ? none.tip_m.x : bad == 1 ? none.tip_m.z : none.tail_m.y) = not_a_number;
                    const TickResult held = renderer.tick(none);
                    CHECK(held.force_n == dvec3(0));
                    CHECK(held.torque_n_m == dvec3(0));
                    CHECK(held.faults == fault_pose_not_finite);
                }
                // Deeper meanwhile than the plate is thick: still the same side.
                const TickResult after = renderer.tick(pose(3e-3));
                CHECK(after.contacts == 1);
                CHECK(after.faults == 0);
                CHECK(glm::length(after.force_n - dvec3(0, 0, 3 * side)) < 1e-8);
            }
}

TEST_CASE("anchors row 8: a tick allocates nothing, whatever is touched and whatever is published meanwhile")
{
    for (const ProbeSettings& probe : every_probe) {
        const auto scene = scene_of_everything(probe);
        Renderer renderer(scene);
        uint64_t allocations = 0, contacts = 0;
        const auto tick = [&](const DevicePose& pose) {
            const uint64_t before = allocations_of_this_thread();
            contacts += renderer.tick(pose).contacts;
            allocations += allocations_of_this_thread() - before;
        };
        for (int i = 0; i < 20'000; ++i) {
            tick(i % 997 == 500 ? at(not_a_number, 0, 0) : stroke(i, probe));
            if (i % 1000 == 0) scene->objects[i / 1000 % 3].texture->publish(sine_texture(40e-6, 2e-3));
        }
        CHECK(contacts > 5000);
        CHECK(allocations == 0);
        // The counter counts.
        const uint64_t before = allocations_of_this_thread();
        CHECK(std::make_unique<double>(1) != nullptr);
        CHECK(allocations_of_this_thread() == before + 1);
    }
}

TEST_CASE("anchors row 8: every tick of a servo is in its histogram, and so is every deadline that it missed")
{
    ServoOptions options;
    options.clock = ServoClock::virtual_time;
    options.seconds = 5;
    options.allocation_count = allocations_of_this_thread;
    ServoThread servo(scene_of_everything(every_probe[0]),
                      std::make_unique<ScriptedDevice>([](uint64_t tick, DevicePose& pose) {
                          pose = stroke(int(tick), every_probe[0]);
                          return DeviceStatus::ok;
                      }),
                      options);
    servo.start();
    const ServoReport report = servo.wait();
    CHECK(report.ticks + report.missed_deadlines == 5000);
    CHECK(report.tick_ns.count() == report.ticks);
    CHECK(report.tick_ns.percentile(0.5) <= report.tick_ns.percentile(0.99));
    CHECK(report.tick_ns.percentile(0.99) <= report.tick_ns.maximum());
    CHECK(report.allocations_in_tick == uint64_t{0});
}

TEST_CASE("anchors row 8: a scene is immutable and shared: four threads feel in it what one feels alone")
{
    static_assert(std::is_constructible_v<Renderer, std::shared_ptr<const Scene>>);
    static_assert(std::is_same_v<decltype(SceneObject::surface), std::shared_ptr<const Surface>>);
    for (const ProbeSettings& probe : every_probe) {
        const auto scene = scene_of_everything(probe);
        const std::vector<dvec3> alone = forces(scene, 20'000);
        std::vector<dvec3> found[4];
        std::vector<std::thread> threads;
        for (std::vector<dvec3>& mine : found) threads.emplace_back([&] { mine = forces(scene, 20'000); });
        for (std::thread& thread : threads) thread.join();
        for (const std::vector<dvec3>& theirs : found) CHECK((theirs == alone));
        CHECK(scene.use_count() == 1); // no renderer keeps it longer than it lives
    }
}
