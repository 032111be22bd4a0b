// Wheels and sticks through the kernel's force feedback, against a model of one that may be wired either way round.
#include "device/axes/axis_device.h"
#include "device/evdev/evdev_axes.h"
#include "device/evdev/open_evdev.h"
#include "runtime/servo/allocation_count.h"
#include "tests/device/evdev/fake_wheel.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

constexpr AxisTimes quick{.nudge_ms = 60, .again_ms = 20, .patience_s = 0.3};
const glm::dvec3 no_torque(0);

// Long enough for any machine; what is waited for comes within moments.
bool comes(const std::function<bool()>& happens)
{
    for (int i = 0; i < 5000; ++i) {
        if (happens()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

struct Opened {
    FakeWheel& wheel;
    AxisDevice device;

    explicit Opened(FakeWheel& of, const EvdevTimes& times = {})
        : wheel(of)
        , device("evdev:fake", [&of, times] { return evdev_axes(of.open(), times); }, {0.4, 20, of.count}, quick)
    {
    }
    DeviceStatus read(DevicePose& pose) { return device.read(pose); }
    DeviceStatus read()
    {
        DevicePose pose;
        return device.read(pose);
    }
    bool becomes(DeviceStatus status)
    {
        return comes([&] { return read() == status; });
    }
    // Ticks until something comes about.
    bool pushes_until(const glm::dvec3& force_n, const std::function<bool()>& happens)
    {
        return comes([&] {
            read();
            device.write(force_n, no_torque);
            return happens();
        });
    }
};

} // namespace

TEST_CASE("a wheel pushes the way it is told, whichever way its motor is wired")
{
    for (const double sign : {1.0, -1.0}) {
        FakeWheel wheel(1);
        wheel.axes[0].sign = sign;
        Opened opened(wheel);
        CHECK(opened.device.info().axes.senses == glm::bvec3(true, false, false));
        REQUIRE(opened.becomes(DeviceStatus::ok));
        wheel.turn_to(0, 0);
        for (const double way : {1.0, -1.0}) {
            const double start = wheel.place(0);
            // 5 N of 20 is a quarter of the level
            CHECK(opened.pushes_until({5 * way, 3, 7}, [&] { return wheel.level(0) == sign * way * 0.25; }));
            CHECK(opened.pushes_until({5 * way, 0, 0}, [&] { return way * (wheel.place(0) - start) > 0.05; }));
        }
        DevicePose pose;
        CHECK(opened.pushes_until({0, 0, 0}, [&] { return wheel.level(0) == 0; }));
        wheel.hold(0, true);
        wheel.turn_to(0, 0.25);
        CHECK(comes([&] { return opened.read(pose) == DeviceStatus::ok && std::fabs(pose.tip_m.x - 0.1) < 1e-5; }));
    }
}

TEST_CASE("a stick has two axes, of which y grows away from the user")
{
    FakeWheel stick(2);
    stick.axes[1].sign = -1;
    Opened opened(stick);
    REQUIRE(opened.becomes(DeviceStatus::ok));
    const double start = stick.place(1);
    CHECK(opened.pushes_until({0, 5, 0}, [&] { return stick.place(1) < start - 0.05; }));
    // more than it can do keeps its direction: 30, 40 of 20
    CHECK(opened.pushes_until({30, 40, 0}, [&] {
        return std::fabs(std::fabs(stick.level(0)) - 0.6) < 1e-12 && std::fabs(std::fabs(stick.level(1)) - 0.8) < 1e-12;
    }));
}

TEST_CASE("a wheel that coasts while it is opened is not taken for one that is pushed")
{
    for (const double speed : {-6.0, 6.0}) { // a third of its way, against the first nudge or the second
        FakeWheel wheel(1);
        wheel.axes[0].speed = speed;
        Opened opened(wheel);
        REQUIRE(opened.becomes(DeviceStatus::ok));
        CHECK(opened.pushes_until({5, 0, 0}, [&] { return wheel.level(0) == 0.25; }));
    }
}

TEST_CASE("a wheel that is held fast has no force until it was felt to move")
{
    FakeWheel wheel(1);
    wheel.hold(0, true);
    Opened opened(wheel);
    CHECK(comes([&] { return opened.device.state().find("let go of it") != std::string::npos; }));
    CHECK(opened.read() == DeviceStatus::not_ready);
    opened.device.write({5, 0, 0}, no_torque);
    wheel.hold(0, false);
    CHECK(opened.becomes(DeviceStatus::ok));
    CHECK(opened.pushes_until({0, 0, 0}, [&] { return wheel.level(0) == 0; }));
}

TEST_CASE("the force of a servo that is silent is taken away, and the hand is told")
{
    FakeWheel wheel(1);
    Opened opened(wheel);
    REQUIRE(opened.becomes(DeviceStatus::ok));
    REQUIRE(opened.pushes_until({5, 0, 0}, [&] { return wheel.level(0) != 0; }));
    CHECK(comes([&] { return wheel.level(0) == 0; })); // nobody ticks
    DevicePose pose;
    CHECK(opened.read(pose) == DeviceStatus::ok);
    CHECK(pose.interrupted);

    REQUIRE(opened.pushes_until({5, 0, 0}, [&] { return wheel.level(0) != 0; }));
    opened.device.stop();
    CHECK(opened.pushes_until({5, 0, 0}, [&] { return wheel.level(0) == 0; }));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    opened.device.write({nan, 0, 0}, no_torque);
    CHECK(wheel.level(0) == 0);
}

TEST_CASE("an effect is played again before anybody ends it")
{
    FakeWheel wheel(1);
    EvdevTimes times;
    times.replay_ms = 20;
    Opened opened(wheel, times);
    REQUIRE(opened.becomes(DeviceStatus::ok));
    const uint64_t before = wheel.replays();
    CHECK(opened.pushes_until({1, 0, 0}, [&] { return wheel.replays() > before + 5; }));
}

TEST_CASE("a wheel that is unplugged is waited for, and one that stays away is disconnected")
{
    FakeWheel wheel(1);
    Opened opened(wheel);
    REQUIRE(opened.becomes(DeviceStatus::ok));
    wheel.is_plugged = false;
    CHECK(opened.becomes(DeviceStatus::not_ready));
    wheel.is_plugged = true;
    DevicePose pose;
    CHECK(comes([&] { return opened.read(pose) == DeviceStatus::ok; }));
    CHECK(pose.interrupted);
    wheel.is_plugged = false;
    CHECK(opened.becomes(DeviceStatus::disconnected));
    CHECK(opened.device.state() == "the wheel is not there");
}

TEST_CASE("whichever call to the kernel fails, the wheel comes back and no force stays")
{
    for (int64_t at = 0; at < 20; at += haptel::test::is_sanitized ? 3 : 1) { // each waits
        CAPTURE(at);
        FakeWheel wheel(1);
        wheel.fails_at = at;
        {
            Opened opened(wheel);
            REQUIRE(opened.pushes_until({5, 0, 0}, [&] {
                return static_cast<int64_t>(wheel.calls()) > at + 20 && opened.read() == DeviceStatus::ok;
            }));
        }
        CHECK(wheel.ports == 0);
        CHECK(wheel.level(0) == 0);
    }
}

TEST_CASE("a wheel is read and written without an allocation")
{
    FakeWheel wheel(1);
    Opened opened(wheel);
    REQUIRE(opened.becomes(DeviceStatus::ok));
    const uint64_t before = allocations_of_this_thread();
    for (int i = 0; i < 1000; ++i) {
        opened.read();
        opened.device.write({1, 0, 0}, no_torque);
    }
    CHECK(allocations_of_this_thread() == before);
}

TEST_CASE("what is written behind evdev: is read, or told with what it should be")
{
    const AxisText read = read_evdev_text("/dev/input/event3,travel_m=0.5,force_max_n=12");
    CHECK(read.error.empty());
    CHECK(read.what == "/dev/input/event3");
    CHECK(read.settings.travel_m == 0.5);
    CHECK(read.settings.force_max_n == 12);
    CHECK(read_evdev_text("").error.find("evdev needs a file") == 0);
    CHECK(read_evdev_text("x,travel_m=-1").error == "`travel_m` must be a number from 0.001 to 10, found '-1'");
    CHECK(read_evdev_text("x,travel_m=nan").error == "`travel_m` must be a number from 0.001 to 10, found 'nan'");
    CHECK(read_evdev_text("x,force_max_n").error == "`force_max_n` must be a number from 0.1 to 100, found ''");
    CHECK(read_evdev_text("x,").error.find("unknown ''") == 0);
    CHECK(open_evdev("/dev/null", {}).error.find("is no input device") != std::string::npos);
    CHECK(open_evdev("/dev/input/nowhere", {}).error.find("is not there") != std::string::npos);
}
