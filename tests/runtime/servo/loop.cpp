// The servo thread: how it starts, keeps time, reports and ends.
#include "runtime/servo/allocation_count.h"
#include "runtime/servo/real_time.h"
#include "runtime/servo/servo_thread.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

Scene textured_plane()
{
    Scene scene = bare_scene(plane_mesh(0.1, 16), sine_texture(60e-6, 1e-3));
    scene.objects[0].material = {1000, 1.0, 0.3, 0.2};
    scene.servo.force_limit_n = 7;
    return scene;
}

// Strokes along the plane, pressing and lifting.
DeviceStatus stroke(uint64_t tick, DevicePose& pose)
{
    const double t = static_cast<double>(tick) * 1e-3;
    pose = at(0.02 * std::sin(5 * t), 0.01 * std::cos(3 * t), 0.2e-3 - 1e-3 * std::sin(7 * t));
    return DeviceStatus::ok;
}

ServoOptions as_fast_as_possible(double seconds)
{
    ServoOptions options;
    options.clock = ServoClock::virtual_time;
    options.seconds = seconds;
    options.allocation_count = allocations_of_this_thread;
    return options;
}

// Runs to the end and returns the report and what was told meanwhile.
ServoReport run(std::unique_ptr<HapticDevice> device, const ServoOptions& options,
                std::vector<TickRecord>* records = nullptr, Scene scene = textured_plane())
{
    ServoThread servo(shared(std::move(scene)), std::move(device), options);
    servo.start();
    const ServoReport report = servo.wait();
    TickRecord record;
    while (records && servo.telemetry().pop(record)) records->push_back(record);
    return report;
}

} // namespace

TEST_CASE("a run on the virtual clock reports what was felt")
{
    std::vector<TickRecord> records;
    auto seen = std::make_shared<ScriptedDevice::Seen>();
    const ServoReport report = run(std::make_unique<ScriptedDevice>(stroke, seen), as_fast_as_possible(2), &records);
    CHECK(report.state == ServoState::finished);
    CHECK(report.stop_reason == "stopped after the requested time");
    CHECK(report.seconds == 2);
    CHECK(report.rate_hz == 1000);
    CHECK(report.ticks == 2000);
    CHECK(report.missed_deadlines == 0);
    CHECK(report.faults == 0);
    CHECK(report.allocations_in_tick == uint64_t{0});
    CHECK(report.records_dropped == 0);
    CHECK(report.tick_ns.count() == 2000);
    CHECK(report.wake_late_ns.count() == 0);
    CHECK(report.reloads == 0);

    REQUIRE(records.size() == 2000);
    double squared = 0, largest = 0, energy = 0;
    uint64_t contacts = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const double force = glm::length(records[i].force_n);
        squared += force * force;
        largest = std::max(largest, force);
        contacts += records[i].contact > 0;
        if (i > 0) energy += glm::dot(records[i - 1].force_n, records[i].tip_m - records[i - 1].tip_m);
        CHECK(records[i].tick == i);
        CHECK(std::abs(records[i].time_s - static_cast<double>(i) * 1e-3) < 1e-12);
    }
    CHECK(report.contact_ticks == contacts);
    CHECK(contacts > 500);
    CHECK(contacts < 2000);
    CHECK(report.force_max_n == largest);
    CHECK(std::abs(report.force_rms_n - std::sqrt(squared / 2000)) < 1e-12);
    CHECK(std::abs(report.energy_j - energy) < 1e-12);
    CHECK(energy < 0); // friction and damping
    CHECK(report.skipped.free_space > 0);

    CHECK(seen->writes == 2001); // the last one is zero
    CHECK(seen->last_force_n == glm::dvec3(0));
    CHECK(seen->stopped);
}

TEST_CASE("a force that is withheld is 0 while the hand is followed, and rises from 0 when it is given back")
{
    for (const double rise_s : {0.1, 0.0}) {
        CAPTURE(rise_s);
        Scene scene = textured_plane();
        scene.servo.force_rise_s = rise_s;
        ServoThread* running = nullptr;
        const auto press = [&](uint64_t tick, DevicePose& pose) {
            if (tick == 500) running->withhold_force(true);
            if (tick == 700) running->withhold_force(false);
            pose = at(0.001, 0.002, -1e-3 * std::min(1.0, static_cast<double>(tick) / 100));
            return DeviceStatus::ok;
        };
        ServoThread servo(shared(std::move(scene)), std::make_unique<ScriptedDevice>(press), as_fast_as_possible(1));
        running = &servo;
        servo.start();
        const ServoReport report = servo.wait();
        CHECK(report.allocations_in_tick == uint64_t{0});
        TickRecord record;
        double full_n = 0;
        while (servo.telemetry().pop(record)) {
            const double force_n = glm::length(record.force_n);
            if (record.tick > 200) CHECK(record.contact == 1);
            if (record.tick == 499) full_n = force_n;
            if (record.tick >= 500 && record.tick < 700) {
                CHECK(force_n == 0);
                CHECK(record.interrupted == 1);
            }
            if (record.tick < 700 || rise_s == 0) continue;
            CHECK(record.interrupted == 0);
            CHECK(force_n <= full_n * std::min(1.0, static_cast<double>(record.tick - 699) / 100) + 1e-12);
        }
        REQUIRE(full_n > 0.5);
        CHECK(std::abs(glm::length(record.force_n) - full_n) < 1e-9);
        CHECK(servo.missed_deadlines() == 0);
    }
}

TEST_CASE("twin runs are equal bit for bit")
{
    std::vector<TickRecord> a, b;
    run(std::make_unique<ScriptedDevice>(stroke), as_fast_as_possible(3), &a);
    run(std::make_unique<ScriptedDevice>(stroke), as_fast_as_possible(3), &b);
    REQUIRE(a.size() == 3000);
    REQUIRE(b.size() == 3000);
    bool equal = true;
    for (std::size_t i = 0; i < a.size(); ++i)
        equal = equal && a[i].force_n == b[i].force_n && a[i].height_m == b[i].height_m && a[i].depth_m == b[i].depth_m;
    CHECK(equal);
}

TEST_CASE("one allocation in one tick is seen")
{
    void* volatile memory = nullptr;
    const ServoReport report = run(std::make_unique<ScriptedDevice>([&](uint64_t tick, DevicePose& pose) {
                                       if (tick == 100) {
                                           memory = std::malloc(16);
                                           std::free(memory);
                                       }
                                       return stroke(tick, pose);
                                   }),
                                   as_fast_as_possible(0.5));
    CHECK(report.allocations_in_tick == uint64_t{1});
}

TEST_CASE("a program that does not count allocations says nothing about them")
{
    ServoOptions options = as_fast_as_possible(0.01);
    options.allocation_count = nullptr;
    CHECK_FALSE(run(std::make_unique<ScriptedDevice>(stroke), options).allocations_in_tick.has_value());
}

TEST_CASE("whatever ends a device ends the run with zero force and the reason")
{
    struct Case {
        DeviceStatus status;
        ServoState state;
        const char* reason;
        const char* device_state = "";
    };
    for (const Case& expected :
         {Case{DeviceStatus::finished, ServoState::finished, "the device's stroke or recording is over"},
          Case{DeviceStatus::disconnected, ServoState::faulted, "the device was disconnected"},
          Case{DeviceStatus::fault, ServoState::faulted, "the device reported a fault"},
          Case{DeviceStatus::fault, ServoState::faulted, "the device reported a fault: it has no program",
               "it has no program"}}) {
        auto seen = std::make_shared<ScriptedDevice::Seen>();
        seen->state = expected.device_state;
        const ServoReport report = run(std::make_unique<ScriptedDevice>(
                                           [&](uint64_t tick, DevicePose& pose) {
                                               stroke(tick, pose);
                                               pose.tip_m.z = -1e-3;
                                               return tick < 250 ? DeviceStatus::ok : expected.status;
                                           },
                                           seen),
                                       as_fast_as_possible(10));
        CHECK(report.state == expected.state);
        CHECK(report.stop_reason == expected.reason);
        CHECK(report.ticks == 250);
        CHECK(report.seconds == 0.25); // the period of the read that found the end is not one of them
        CHECK(seen->last_force_n == glm::dvec3(0));
        CHECK(seen->stopped);
    }
}

TEST_CASE("a device that is not ready is sent zero force and waited for")
{
    auto seen = std::make_shared<ScriptedDevice::Seen>();
    const ServoReport report = run(std::make_unique<ScriptedDevice>(
                                       [](uint64_t tick, DevicePose& pose) {
                                           pose = at(std::nan(""), 0, 0);
                                           if (tick < 100) return DeviceStatus::not_ready;
                                           return stroke(tick, pose);
                                       },
                                       seen),
                                   as_fast_as_possible(0.3));
    CHECK(report.ticks == 200);
    CHECK(report.seconds == 0.3);
    CHECK(report.faults == 0);
}

TEST_CASE("a device that is away for a while comes back to a force that rises")
{
    Scene scene = textured_plane();
    scene.servo.force_rise_s = 0.05;
    std::vector<TickRecord> records;
    run(std::make_unique<ScriptedDevice>([](uint64_t tick, DevicePose& pose) {
            pose = at(0.001, 0.002, tick < 10 ? 1e-3 : -1e-3);
            return tick >= 200 && tick < 230 ? DeviceStatus::not_ready : DeviceStatus::ok;
        }),
        as_fast_as_possible(0.5), &records, std::move(scene));
    REQUIRE(records.size() == 470);
    const double full_n = glm::length(records[199].force_n);
    REQUIRE(full_n > 0.5);
    CHECK(std::abs(records[199].time_s - 0.199) < 1e-12);
    CHECK(std::abs(records[200].time_s - 0.230) < 1e-12);
    CHECK(records[200].interrupted == 1);
    CHECK(records[201].interrupted == 0);
    for (std::size_t i = 200; i < 470; ++i)
        CHECK(std::abs(glm::length(records[i].force_n) - full_n * std::min(1.0, double(i - 200) / 50)) < 1e-9);
}

TEST_CASE("while a device is away no force gives energy to its hand, neither in the run nor in its replay")
{
    // Pressed in by 1 mm: 1 N that would be 0.1 J on the way of 10 cm.
    for (const bool told_by_pose : {false, true}) {
        std::vector<TickRecord> records;
        const ServoReport report =
            run(std::make_unique<ScriptedDevice>([&](uint64_t tick, DevicePose& pose) {
                    pose = at(0, 0, tick < 50 ? 1e-3 : tick < 100 ? -1e-3 : 0.1);
                    pose.interrupted = told_by_pose && tick == 100;
                    return !told_by_pose && tick >= 100 && tick < 200 ? DeviceStatus::not_ready : DeviceStatus::ok;
                }),
                as_fast_as_possible(0.3), &records, bare_scene(plane_mesh()));
        CHECK(records.size() == (told_by_pose ? 300 : 200));
        CHECK(std::abs(report.energy_j) < 1e-12); // no force on the way in, and none since
        const ServoReport again = run(std::make_unique<ScriptedDevice>([&](uint64_t tick, DevicePose& pose) {
                                          if (tick == records.size()) return DeviceStatus::finished;
                                          pose = {records[tick].tip_m, records[tick].tail_m};
                                          pose.interrupted = records[tick].interrupted != 0;
                                          return DeviceStatus::ok;
                                      }),
                                      as_fast_as_possible(0.4), nullptr, bare_scene(plane_mesh()));
        CHECK(again.energy_j == report.energy_j);
    }
}

TEST_CASE("missed deadlines stand in the trace's time, not for a hand that has a time of its own")
{
    for (const bool own_time : {false, true}) {
        std::vector<TickRecord> records;
        ServoOptions options;
        options.seconds = 0.1;
        options.ask_for_real_time = false;
        const ServoReport report =
            run(std::make_unique<ScriptedDevice>([&](uint64_t tick, DevicePose& pose) {
                    if (tick == 10)
                        for (const int64_t until = monotonic_ns() + 3'500'000; monotonic_ns() < until;) {
                        }
                    const DeviceStatus status = stroke(tick, pose);
                    if (own_time) pose.periods = 1;
                    return status;
                }),
                options, &records);
        REQUIRE(report.missed_deadlines >= 3);
        REQUIRE(records.size() == report.ticks);
        const double last = std::round(records.back().time_s * 1e3); // number of the last tick's period
        if (own_time) {
            CHECK(last == static_cast<double>(report.ticks - 1));
        } else {
            CHECK(records[11].time_s - records[10].time_s > 3.9e-3);
            CHECK(last >= static_cast<double>(report.ticks - 1 + 3));
            CHECK(last <= static_cast<double>(report.ticks - 1 + report.missed_deadlines)); // the last one may be late
        }
    }
}

TEST_CASE("a tick with a broken pose is counted and the run goes on")
{
    std::vector<TickRecord> records;
    const ServoReport report = run(std::make_unique<ScriptedDevice>([](uint64_t tick, DevicePose& pose) {
                                       stroke(tick, pose);
                                       if (tick % 10 == 3) pose.tip_m.y = std::numeric_limits<double>::quiet_NaN();
                                       return DeviceStatus::ok;
                                   }),
                                   as_fast_as_possible(1), &records);
    CHECK(report.state == ServoState::finished);
    CHECK(report.faults == 100);
    CHECK(report.fault_bits == fault_pose_not_finite);
    CHECK(std::isfinite(report.energy_j));
    for (const TickRecord& record : records) {
        CHECK(std::isfinite(record.force_n.x + record.force_n.y + record.force_n.z));
        if (record.faults) CHECK(record.force_n == glm::dvec3(0));
    }
}

TEST_CASE("telemetry that nobody reads is dropped and counted, or waited for on the virtual clock")
{
    ServoOptions options = as_fast_as_possible(1);
    options.telemetry_capacity = 128;
    const ServoReport dropped = run(std::make_unique<ScriptedDevice>(stroke), options);
    CHECK(dropped.ticks == 1000);
    CHECK(dropped.records_dropped == 1000 - 128);

    options.wait_for_reader = true;
    ServoThread servo(shared(textured_plane()), std::make_unique<ScriptedDevice>(stroke), options);
    servo.start();
    uint64_t read = 0;
    TickRecord record;
    while (servo.running())
        if (servo.telemetry().pop(record))
            CHECK(record.tick == read++);
        else
            std::this_thread::yield();
    while (servo.telemetry().pop(record)) ++read;
    CHECK(read == 1000);
    CHECK(servo.wait().records_dropped == 0);
}

TEST_CASE("a run stops on request, even one that waits for its reader")
{
    ServoOptions options = as_fast_as_possible(std::numeric_limits<double>::infinity());
    options.telemetry_capacity = 64;
    options.wait_for_reader = true;
    ServoThread servo(shared(textured_plane()), std::make_unique<ScriptedDevice>(stroke), options);
    servo.start();
    servo.request_stop();
    CHECK(servo.wait().state == ServoState::stopped);
    CHECK_FALSE(servo.running());
}

TEST_CASE("on the wall clock every period is a tick or a missed deadline")
{
    ServoOptions options;
    options.seconds = 0.2;
    const ServoReport report = run(std::make_unique<ScriptedDevice>(stroke), options);
    CHECK(report.state == ServoState::finished);
    CHECK(report.ticks + report.missed_deadlines >= 200);
    CHECK(report.wake_late_ns.count() == report.ticks);
    CHECK(report.real_time == report.real_time_note.empty());
}

TEST_CASE("a tick that takes three periods is counted as missed deadlines and not caught up")
{
    ServoOptions options;
    options.seconds = 0.1;
    options.ask_for_real_time = false;
    const int64_t start_ns = monotonic_ns();
    const ServoReport report = run(std::make_unique<ScriptedDevice>([](uint64_t tick, DevicePose& pose) {
                                       if (tick == 10) {
                                           const int64_t until = monotonic_ns() + 3'500'000;
                                           while (monotonic_ns() < until) {
                                           }
                                       }
                                       return stroke(tick, pose);
                                   }),
                                   options);
    CHECK(report.missed_deadlines >= 3);
    CHECK(report.ticks <= 97);
    CHECK(report.seconds >= 0.1);
    // Its periods are those of the wall clock, none counted twice.
    CHECK(report.seconds < 1e-9 * static_cast<double>(monotonic_ns() - start_ns) + 1e-3);
}

#if defined(__SSE2__)
TEST_CASE("the servo computes with subnormal numbers, whatever its parent does")
{
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040u); // flush to zero, subnormals are zero: inherited by threads
    volatile double tiny = std::numeric_limits<double>::min(), half = 0.5;
    volatile double product = tiny * half; // volatile: not to be computed after the mode is set back
    const bool flushed_here = product == 0.0;
    bool flushed_there = true;
    run(std::make_unique<ScriptedDevice>([&](uint64_t tick, DevicePose& pose) {
            flushed_there = tiny * half == 0.0;
            return stroke(tick, pose);
        }),
        as_fast_as_possible(0.01));
    _mm_setcsr(before);
    CHECK(flushed_here);
    CHECK_FALSE(flushed_there);
}
#endif

TEST_CASE("textures published 200 times from two threads while a servo runs")
{
    Scene scene = textured_plane();
    const auto slot = scene.objects[0].texture;
    ServoOptions options = as_fast_as_possible(std::numeric_limits<double>::infinity());
    ServoThread servo(shared(std::move(scene)), std::make_unique<ScriptedDevice>(stroke), options);
    servo.start();
    std::thread other([&] {
        for (int i = 0; i < 100; ++i) slot->publish(sine_texture(20e-6, 2e-3));
    });
    for (int i = 0; i < 100; ++i) slot->publish(sine_texture(40e-6, 1e-3 + i * 1e-5));
    other.join();
    servo.request_stop();
    const ServoReport& report = servo.wait();
    CHECK(report.reloads == 200);
    CHECK(report.allocations_in_tick == uint64_t{0});
    CHECK(report.faults == 0);
    CHECK(report.force_max_n <= 7);
}
