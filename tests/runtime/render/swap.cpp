// A scene in the place of another one while a hand is in it: what goes on, and who frees what is gone.
#include "runtime/servo/allocation_count.h"
#include "runtime/servo/servo_thread.h"
#include "tests/runtime/render/swap_stage.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

TEST_CASE("a scene that changes nothing is not felt")
{
    for (const ProbeKind probe : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus}) {
        Scene first = plane_scene();
        first.probe = {probe, 0.1, probe == ProbeKind::sphere ? 2e-3 : 0};
        const double radius_m = first.probe.radius_m;
        const auto scene = shared(std::move(first));
        Stage stage(scene);
        const auto hand = [&](double z) {
            return DevicePose{{0.01, 0.02, z + radius_m}, {0.01, 0.02, z + radius_m + 0.1}};
        };
        stage.tick(hand(1e-3));
        for (int i = 0; i < 200; ++i) stage.tick(hand(-1e-3));
        stage.slot.publish(shared(same_as(*scene)));
        for (int i = 0; i < 300; ++i) {
            const TickResult result = stage.tick(hand(-1e-3));
            CHECK(std::abs(result.force_n.z - 1) < 1e-8);
            CHECK(result.contacts == 1);
            CHECK_FALSE(result.interrupted);
        }
    }
}

TEST_CASE("a hand that leaves does not feel a scene that changes nothing, however often it comes")
{
    for (const int every : {1, 20, 1000}) {
        const auto scene = shared(plane_scene(800));
        Stage stage(scene);
        stage.press(1e-3, 1);
        stage.press(-6e-3, 200);
        for (int i = 0; i < 60; ++i) {
            if (i % every == 0) stage.slot.publish(shared(same_as(*scene)));
            const double z = -6e-3 + 0.15e-3 * i;
            CHECK(std::abs(stage.press(z, 1).force_n.z - 800 * std::max(0.0, -z)) < 1e-8);
        }
    }
}

TEST_CASE("friction holds where it held, and a moving object moves on")
{
    Scene first = plane_scene();
    first.objects[0].material = {1000, 0, 0.5, 0.3};
    const auto scene = shared(std::move(first));
    Stage stage(scene);
    stage.tick(at(0, 0, 1e-3));
    for (int i = 0; i < 200; ++i) stage.tick(at(0, 0, -1e-3));
    for (int i = 0; i < 200; ++i) stage.tick(at(0.3e-3, 0, -1e-3));
    stage.slot.publish(shared(same_as(*scene)));
    for (int i = 0; i < 200; ++i) CHECK(std::abs(stage.tick(at(0.3e-3, 0, -1e-3)).force_n.x + 0.3) < 1e-8);

    Scene turning = plane_scene();
    SteadyMotion::Figures figures;
    figures.swing_m = {0, 0, 5e-3};
    figures.swing_hz = 1;
    turning.objects[0].motion = std::make_shared<SteadyMotion>(turning.objects[0].placement, figures);
    const auto swinging = shared(std::move(turning));
    Stage moved(swinging), plain(swinging);
    for (int i = 0; i < 1000; ++i) {
        if (i == 150) moved.slot.publish(shared(same_as(*swinging)));
        const TickResult a = moved.press(4.5e-3, 1), b = plain.press(4.5e-3, 1);
        CHECK(a.contacts == b.contacts);
        if (i > 260) CHECK(a.force_n == b.force_n);
        CHECK(a.depth_m == b.depth_m);
    }
}

// Its tail alone is on the plane and sticks there, drawn by 0.3 of the depth of 1 mm; its tip is in the air.
TEST_CASE("friction goes on holding the tail of a stylus, on the surface that was there and on one built anew")
{
    for (const bool anew : {false, true}) {
        Scene first = plane_scene();
        first.probe = {ProbeKind::stylus, 0.08, 0};
        first.objects[0].material = {1000, 0, 0.5, 0.1};
        Scene second = same_as(first);
        if (anew) second.objects[0].surface = build_surface(plane_mesh(0.1, 3)).surface;
        const auto hand = [](double x, double z) { return DevicePose{{x, 0.01, z + 0.08}, {x, 0.01, z}}; };
        Stage stage(shared(std::move(first)));
        for (int i = 0; i < 50; ++i) stage.tick(hand(0.01, 1e-3 - 4e-5 * i));
        for (int i = 0; i < 200; ++i) stage.tick(hand(0.01 + std::min(i, 100) * 3e-6, -1e-3));
        CAPTURE(anew);
        CHECK(std::abs(stage.tick(hand(0.0103, -1e-3)).force_n.x + 0.3) < 1e-6);
        stage.slot.publish(shared(std::move(second)));
        for (int i = 0; i < 200; ++i) CHECK(std::abs(stage.tick(hand(0.0103, -1e-3)).force_n.x + 0.3) < 1e-6);
    }
}

TEST_CASE("an object that slept while the hand went round it is met from where the hand is")
{
    const auto scene = shared(plane_scene());
    Stage stage(scene);
    for (int i = 0; i <= 3000; ++i) { // from above the plane of 0.1 m to below it, far outside
        const double t = 3.14159265358979 * i / 3000;
        stage.tick(at(0.3 * std::sin(t), 0, 0.3 * std::cos(t)));
    }
    REQUIRE(stage.renderer->skipped().objects > 2900);
    stage.slot.publish(shared(same_as(*scene)));
    for (int i = 0; i < 10; ++i) CHECK(stage.tick(at(0, 0, -0.3)).contacts == 0);
    for (int i = 0; i < 100; ++i) stage.tick(at(0, 0, -0.3 + 0.003 * i));
    CHECK(stage.tick(at(0, 0, 1e-3)).contacts == 1); // from below
}

TEST_CASE("a scene that was never ticked hands on where the hand touched")
{
    // As while a device is not ready: two other planes, one after the other, in the place of the one that is pressed.
    Scene second = plane_scene(), third = plane_scene();
    second.objects[0].surface = build_surface(plane_mesh(0.1, 7)).surface;
    third.objects[0].surface = build_surface(plane_mesh(0.1, 5)).surface;
    Stage stage(shared(plane_scene()));
    stage.press(1e-3, 1);
    stage.press(-1e-3, 200);
    for (const Scene& next : {second, third}) {
        stage.slot.publish(shared(same_as(next)));
        REQUIRE(stage.slot.take(stage.renderer));
    }
    CHECK(std::abs(stage.press(-1e-3, 200).force_n.z - 1) < 1e-8);
}

TEST_CASE("of scenes published between two ticks the newest is felt, and what is replaced is freed by who publishes")
{
    const auto scene = shared(plane_scene());
    Stage stage(scene);
    stage.press(1e-3, 1);
    stage.press(-1e-3, 200);
    std::vector<std::weak_ptr<const Scene>> published;
    for (int i = 1; i <= 5; ++i) {
        Scene next = same_as(*scene);
        next.objects[0].material.stiffness_n_per_m = 1000 + 100 * i;
        const auto held = shared(std::move(next));
        published.push_back(held);
        stage.slot.publish(held);
    }
    for (int i = 0; i < 4; ++i) CHECK(published[static_cast<std::size_t>(i)].expired());
    CHECK(std::abs(stage.press(-1e-3, 200).force_n.z - 1.5) < 1e-8);
    // The servo has given back one renderer that nobody collects: it goes on, and does not free it.
    const uint64_t before = allocations_of_this_thread();
    stage.press(-1e-3, 10);
    CHECK(allocations_of_this_thread() == before);
    Scene last = same_as(*scene);
    stage.slot.publish(shared(std::move(last)));
    CHECK_FALSE(published.back().expired()); // felt until the next tick
    stage.press(-1e-3, 1);
    stage.slot.collect();
    CHECK(published.back().expired());
}

namespace {

// Is asked where its object is when a renderer takes over, and does something else first, once.
class Occasion final : public Motion {
public:
    std::function<void()> meanwhile;
    std::optional<Placement> at(double) const noexcept override
    {
        if (meanwhile) std::exchange(const_cast<Occasion*>(this)->meanwhile, {})();
        return std::nullopt;
    }
};

} // namespace

TEST_CASE("a scene published while the one before is taken is felt next, and those before are freed")
{
    auto first = shared(plane_scene());
    const auto occasion = std::make_shared<Occasion>();
    Scene moved = same_as(*first), third = same_as(*first);
    moved.objects[0].motion = occasion;
    third.objects[0].material.stiffness_n_per_m = 2000;
    auto second = shared(std::move(moved)), last = shared(std::move(third));
    const std::weak_ptr<const Scene> first_alive = first, second_alive = second, last_alive = last;
    Stage stage(first);
    stage.press(1e-3, 1);
    stage.press(-1e-3, 200);
    first.reset();
    stage.slot.publish(std::move(second));
    occasion->meanwhile = [&] { std::thread([&] { stage.slot.publish(std::move(last)); }).join(); };
    CHECK(stage.slot.take(stage.renderer));
    CHECK_FALSE(occasion->meanwhile); // it was published in the middle of that
    CHECK(stage.slot.take(stage.renderer));
    CHECK_FALSE(stage.slot.take(stage.renderer));
    CHECK(std::abs(stage.press(-1e-3, 200).force_n.z - 2) < 1e-8);
    stage.slot.collect();
    CHECK(first_alive.expired());
    CHECK(second_alive.expired());
    CHECK_FALSE(last_alive.expired());
}

TEST_CASE("of scenes published as fast as a servo takes them none is left")
{
    const auto scene = shared(plane_scene());
    Stage stage(scene);
    stage.press(-1e-3, 1);
    std::vector<std::weak_ptr<const Scene>> published;
    std::atomic<bool> stop = false;
    std::atomic<uint64_t> taken = 0;
    std::thread servo([&] {
        while (!stop.load(std::memory_order_relaxed)) {
            if (stage.slot.take(stage.renderer))
                ++taken;
            else
                std::this_thread::yield();
        }
    });
    for (int i = 0; i < 3000 || taken <= 10; ++i) { // on a busy machine the servo is late
        const auto next = shared(same_as(*scene));
        published.push_back(next);
        stage.slot.publish(next);
        if (i % 3 == 0) std::this_thread::yield();
        if (i % 7 == 0) stage.slot.collect();
    }
    stop = true;
    servo.join();
    while (stage.slot.take(stage.renderer)) ++taken;
    stage.slot.collect();
    uint64_t alive = 0;
    for (const auto& one : published) alive += !one.expired();
    CHECK(alive == 1);
    CHECK_FALSE(published.back().expired()); // the newest is what is felt
}

TEST_CASE(
    "scenes are swapped hundreds of times while a servo runs: nothing is allocated in a tick, nothing falls through")
{
    Mesh mesh = make_icosphere(3);
    scale_to_size(mesh, 0.1);
    const auto coarse = build_surface(mesh).surface;
    const auto make = [&](int i) {
        Scene scene = bare_scene(plane_mesh(), sine_texture(20e-6, 2e-3));
        scene.objects[0].surface = coarse;
        scene.objects[0].material = {600.0 + 10 * (i % 40), 0.5, 0.3, 0.2};
        for (int k = 0; k < i % 5; ++k) { // others come and go before it
            SceneObject other = scene.objects.back();
            other.placement.position_m = {1.0 + k, 0, 0};
            other.texture = std::make_shared<TextureSlot>();
            scene.objects.insert(scene.objects.begin(), other);
        }
        scene.servo.force_rise_s = 0.02;
        return shared(std::move(scene));
    };
    const auto hand = [](uint64_t tick, DevicePose& pose) { // 1 mm deep round the ball
        const double t = static_cast<double>(tick) * 1e-3;
        const double r = tick < 20 ? 0.06 : 0.049;
        const glm::dvec3 tip(r * std::cos(t), r * std::sin(t) * std::cos(0.3), r * std::sin(t) * std::sin(0.3));
        pose = {tip, tip};
        std::this_thread::sleep_for(std::chrono::microseconds(20));
        return DeviceStatus::ok;
    };
    ServoOptions options;
    options.clock = ServoClock::virtual_time;
    options.seconds = 20;
    options.telemetry_capacity = 1 << 15;
    options.allocation_count = allocations_of_this_thread;
    ServoThread servo(make(0), std::make_unique<ScriptedDevice>(hand), options);
    Scene slower = *make(1);
    slower.servo.rate_hz = 500;
    CHECK(servo.publish(shared(std::move(slower))) ==
          "the rate of a servo cannot change while it runs: stop it and start anew");
    servo.start();
    std::vector<std::weak_ptr<const Scene>> published;
    for (int i = 1; servo.running() && i <= 400; ++i) {
        const auto scene = make(i);
        published.push_back(scene);
        CHECK(servo.publish(scene).empty());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    servo.request_stop();
    const ServoReport& report = servo.wait();
    servo.collect();
    CHECK(report.allocations_in_tick == 0);
    CHECK(report.scenes_swapped > 50);
    CHECK(report.faults == 0);
    uint64_t alive = 0;
    for (const auto& scene : published) alive += !scene.expired();
    CHECK(alive <= 2); // what is felt, and one that came too late
    uint64_t free_ticks = 0, ticks = 0;
    double largest_step_n = 0, last_n = 0;
    for (TickRecord record; servo.telemetry().pop(record);) {
        const double force_n = glm::length(record.force_n);
        if (record.tick > 100) {
            ++ticks;
            free_ticks += record.contact == 0;
            largest_step_n = std::max(largest_step_n, std::abs(force_n - last_n));
        }
        last_n = force_n;
    }
    CAPTURE(ticks, report.scenes_swapped);
    CHECK(ticks > 500);
    CHECK(free_ticks == 0);
    CHECK(largest_step_n < 0.1);
}
