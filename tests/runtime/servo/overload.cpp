// A servo that cannot keep its deadlines: what it leaves out, when, and that nobody feels a step; in the run as in its
// replay.
#include "runtime/servo/overload.h"
#include "runtime/render/renderer.h"
#include "runtime/servo/allocation_count.h"
#include "runtime/servo/real_time.h"
#include "runtime/servo/servo_thread.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

// A window of that many periods at 1 kHz, of which so many are missed, two after a tick.
void window(OverloadPolicy& policy, uint64_t missed, uint64_t periods = 100)
{
    uint64_t left = missed;
    for (uint64_t period = 0; period < periods;) {
        const uint64_t now = std::min({left, uint64_t{2}, periods - period - 1});
        policy.tick(now);
        left -= now;
        period += 1 + now;
    }
    REQUIRE(left == 0);
}

// A plane with a texture 0.3 mm below its upper bound, and a magnet on it.
Scene textured_magnet()
{
    Scene scene = bare_scene(plane_mesh(), lambda_texture(
                                               [](const haptel_point&, glm::dvec3& gradient) {
                                                   gradient = glm::dvec3(0);
                                                   return -0.3e-3;
                                               },
                                               -0.5e-3, 0));
    scene.objects[0].effects.magnet = {1, 0.01};
    return scene;
}

constexpr int fade_ticks = 50; // fade_s at 1 kHz

} // namespace

TEST_CASE("what is left out follows the share of deadlines that is missed, by steps and back")
{
    OverloadPolicy policy(1000);
    for (int i = 0; i < 50; ++i) window(policy, 19);
    CHECK(policy.step() == Degradation::none);
    for (int i = 0; i < 2; ++i) window(policy, 20);
    window(policy, 19); // not three in a row
    for (int i = 0; i < 2; ++i) window(policy, 20);
    CHECK(policy.step() == Degradation::none);
    window(policy, 20);
    CHECK(policy.step() == Degradation::no_effects);
    for (int i = 0; i < 2; ++i) window(policy, 20);
    CHECK(policy.step() == Degradation::no_effects);
    window(policy, 20);
    CHECK(policy.step() == Degradation::no_textures);
    for (int i = 0; i < 50; ++i)
        window(policy, 49); // bare surfaces are felt for as long as half of the ticks are in time
    CHECK(policy.step() == Degradation::no_textures);
    for (int i = 0; i < 50; ++i) window(policy, i % 2 ? 19 : 3); // neither good nor bad
    CHECK(policy.step() == Degradation::no_textures);
    for (int i = 0; i < 9; ++i) window(policy, 2);
    CHECK(policy.step() == Degradation::no_textures);
    window(policy, 0);
    CHECK(policy.step() == Degradation::no_effects);
    for (int i = 0; i < 9; ++i) window(policy, 0);
    window(policy, 3); // not ten in a row
    for (int i = 0; i < 9; ++i) window(policy, 0);
    CHECK(policy.step() == Degradation::no_effects);
    window(policy, 0);
    CHECK(policy.step() == Degradation::none);
}

TEST_CASE("the force is taken away only where bare surfaces are late for long")
{
    OverloadPolicy policy(1000);
    for (int i = 0; i < 6; ++i) window(policy, 60);
    CHECK(policy.step() == Degradation::no_textures);
    for (int i = 0; i < 9; ++i) window(policy, 60);
    window(policy, 40); // not ten in a row
    for (int i = 0; i < 9; ++i) window(policy, 60);
    CHECK(policy.step() == Degradation::no_textures);
    window(policy, 60);
    CHECK(policy.step() == Degradation::no_force);
    for (int i = 0; i < 50; ++i) window(policy, 0);
    CHECK(policy.step() == Degradation::no_force);
}

TEST_CASE("one tick that is late by an hour is one window, and windows are times whatever the rate")
{
    OverloadPolicy once(1000);
    for (int i = 0; i < 2; ++i) once.tick(3'600'000);
    CHECK(once.step() == Degradation::none);
    once.tick(3'600'000);
    CHECK(once.step() == Degradation::no_effects);
    for (const double rate_hz : {500.0, 1000.0, 4000.0, 20'000.0}) {
        const auto periods = static_cast<uint64_t>(0.1 * rate_hz);
        OverloadPolicy policy(rate_hz);
        for (int i = 0; i < 2; ++i) policy.tick(periods);
        policy.tick(periods / 2);
        for (uint64_t i = 1 + periods / 2; i < periods; ++i) {
            CHECK(policy.step() == Degradation::none);
            policy.tick(0);
        }
        CHECK(policy.step() == Degradation::no_effects);
    }
}

TEST_CASE("what is left out fades, and what comes back does")
{
    // Above the plane the magnet pulls, by 4 F x (1 - x); 1 mm below it the plane pushes by K (d + h - h_max).
    for (const bool above : {true, false}) {
        Renderer renderer(shared(textured_magnet()));
        const double z = above ? 2.5e-3 : -1e-3, pull_n = -4 * 0.25 * 0.75, bare_n = 1000 * 1e-3;
        const auto expected = [&](double effects, double textures, double force) {
            return force * (above ? effects * pull_n : bare_n - textures * 1000 * 0.3e-3);
        };
        renderer.tick(at(0.01, 0.02, 4e-3));
        double effects = 1, textures = 1, force = 1, last_n = 0;
        const auto degraded = [&](Degradation degradation, int ticks) {
            for (int i = 0; i < ticks; ++i) {
                DevicePose pose = at(0.01, 0.02, z);
                pose.degradation = degradation;
                const auto fade = [&](double& share, Degradation left_out) {
                    share = std::clamp(share + (degradation >= left_out ? -1.0 : 1.0) / fade_ticks, 0.0, 1.0);
                };
                fade(effects, Degradation::no_effects);
                fade(textures, Degradation::no_textures);
                fade(force, Degradation::no_force);
                const uint64_t allocated = allocations_of_this_thread();
                const TickResult felt = renderer.tick(pose);
                CHECK(allocations_of_this_thread() == allocated);
                CHECK(std::abs(felt.force_n.z - expected(effects, textures, force)) < 1e-9);
                if (i > 0) CHECK(std::abs(felt.force_n.z - last_n) < 2.01 / fade_ticks); // two may fade at once
                last_n = felt.force_n.z;
            }
        };
        degraded(Degradation::none, 20);
        degraded(Degradation::no_effects, 70);
        const uint64_t spared = renderer.skipped().texture;
        degraded(Degradation::no_textures, 70);
        if (!above) CHECK(renderer.skipped().texture - spared >= 20); // no longer evaluated
        degraded(Degradation::no_effects, 20);                        // before all of it is back
        degraded(Degradation::none, 70);
        CHECK(!renderer.faded_away());
        degraded(Degradation::no_force, 60);
        CHECK(renderer.faded_away());
        CHECK(last_n == 0);
        degraded(Degradation::none, 70);
    }
}

TEST_CASE("a servo that misses most of its deadlines says what it leaves out, and ends with no force and the reason")
{
    const auto scene = shared(textured_magnet());
    auto seen = std::make_shared<ScriptedDevice::Seen>();
    ServoOptions options;
    options.seconds = 30;
    options.ask_for_real_time = false;
    options.allocation_count = allocations_of_this_thread;
    ServoThread servo(scene,
                      std::make_unique<ScriptedDevice>(
                          [](uint64_t tick, DevicePose& pose) { // of each three periods it takes more than two
                              for (const int64_t until = monotonic_ns() + 2'200'000; monotonic_ns() < until;) {
                              }
                              pose = at(0, 0, tick < 5 ? 1e-3 : -1e-3 + 1e-4 * std::sin(0.01 * double(tick)));
                              return DeviceStatus::ok;
                          },
                          seen),
                      options);
    servo.start();
    const ServoReport report = servo.wait();
    CHECK(report.state == ServoState::faulted);
    CHECK(report.stop_reason.starts_with("the servo missed more than half of its deadlines for a second"));
    CHECK(seen->last_force_n == glm::dvec3(0));
    CHECK(seen->stopped);
    CHECK(report.degraded.without_force > 0);
    CHECK(report.degraded.without_textures > report.degraded.without_force);
    CHECK(report.degraded.without_effects > report.degraded.without_textures);
    CHECK(report.ticks > report.degraded.without_effects);
    CHECK(report.allocations_in_tick == uint64_t{0});

    // Its replay leaves out the same on the virtual clock, which misses nothing, and ends as the recording does.
    std::vector<TickRecord> records, again;
    for (TickRecord record; servo.telemetry().pop(record);) records.push_back(record);
    REQUIRE(records.size() == report.ticks);
    options.clock = ServoClock::virtual_time;
    ServoThread replay(scene, std::make_unique<ScriptedDevice>([&](uint64_t tick, DevicePose& pose) {
                           if (tick == records.size()) return DeviceStatus::finished;
                           const TickRecord& record = records[tick];
                           pose = {record.tip_m, record.tail_m, 1, record.interrupted != 0,
                                   static_cast<Degradation>(record.degradation)};
                           if (tick > 0)
                               pose.periods = static_cast<uint64_t>(
                                   std::llround(1000 * (record.time_s - records[tick - 1].time_s)));
                           return DeviceStatus::ok;
                       }),
                       options);
    replay.start();
    CHECK(replay.wait().state == ServoState::finished);
    CHECK(replay.wait().missed_deadlines == 0);
    CHECK(replay.wait().degraded.without_effects == report.degraded.without_effects);
    for (TickRecord record; replay.telemetry().pop(record);) again.push_back(record);
    REQUIRE(again.size() == records.size());
    bool equal = true;
    for (std::size_t i = 0; i < records.size(); ++i)
        equal = equal && records[i].force_n == again[i].force_n && records[i].degradation == again[i].degradation;
    CHECK(equal);
}
