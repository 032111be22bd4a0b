#include "device/falcon/falcon_device.h"
#include "runtime/servo/allocation_count.h"
#include "tests/device/falcon/fake_transport.h"
#include "tests/device/falcon/falcon_truth.h"
#include "tests/device/falcon/firmware_image.h"
#include "tests/device/falcon/quick_falcon.h"
#include "tests/support/catch.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

using namespace haptel::device;
using namespace haptel::runtime;
using glm::dvec3;

namespace {

bool becomes(FalconDevice& device, DeviceStatus wanted, const dvec3& force_n = dvec3(0))
{
    return tick_until(device, force_n, [&](DeviceStatus status) { return status == wanted; });
}

bool holds(FalconDevice& device, const FakeFalcon& falcon, const dvec3& force_n, const FakeFalcon::Motors& motors)
{
    return tick_until(device, force_n, [&](DeviceStatus) { return falcon.motors() == motors; });
}

} // namespace

TEST_CASE("the world is the device's, turned: x right, y away from the user, z up, zero at the workspace's centre")
{
    CHECK(falcon_world_m({0, 0, 0.125}) == dvec3(0));
    CHECK(falcon_world_m({0.01, 0, 0.125}) == dvec3(0.01, 0, 0));                    // right
    CHECK(falcon_world_m({0, 0.01, 0.125}) == dvec3(0, 0, 0.01));                    // up
    CHECK(glm::distance(falcon_world_m({0, 0, 0.135}), dvec3(0, -0.01, 0)) < 1e-15); // towards the user
    CHECK(glm::distance(falcon_device_direction(falcon_world_m({1, 2, 3.125})), dvec3(1, 2, 3)) < 1e-12);
}

TEST_CASE("a Falcon is loaded, homed and then felt where it is")
{
    FakeFalcon falcon(false, 30);
    const dvec3 place_m(0.011, -0.007, 0.118);
    falcon.set_encoders(encoders_at(place_m));
    falcon.set_buttons(5);
    FalconDevice device("falcon", open_fake(falcon), quick_options());
    CHECK(device.info().name == "falcon");
    CHECK(device.info().force_max_n == 7);
    CHECK(device.info().stiffness_max_n_per_m == 2000);

    // A servo that pushes from the start pushes nobody before the arms are homed.
    REQUIRE(becomes(device, DeviceStatus::ok, {0, 0, 3}));
    CHECK(falcon.image() == synthetic_firmware(50));
    CHECK(falcon.violations() == 0);
    DevicePose pose;
    CHECK(device.read(pose) == DeviceStatus::ok);
    CHECK(glm::distance(pose.tip_m, dvec3(0.011, 0.007, -0.007)) < 0.05e-3); // counts are steps of 0.04 mm
    CHECK(pose.tail_m == pose.tip_m);
    CHECK(pose.periods == 0);
    CHECK(device.buttons() == 5);
    CHECK(device.state() == "connected");
    CHECK(tick_until(device, dvec3(0), [&](DeviceStatus) { return falcon.flags() == falcon_blue; }));
}

TEST_CASE("the motors get the torques of the force, within one count, up to 7 N, and zero for what is no number")
{
    const dvec3 place_m(-0.012, 0.015, 0.131);
    FakeFalcon falcon(true);
    falcon.set_encoders(encoders_at(place_m));
    FalconDevice device("falcon", open_fake(falcon), quick_options());
    REQUIRE(becomes(device, DeviceStatus::ok));
    const auto near = [&](const dvec3& force_n, const dvec3& expected) {
        return tick_until(device, force_n, [&](DeviceStatus) {
            const auto motors = falcon.motors();
            return glm::length(dvec3(motors[0], motors[1], motors[2]) - expected) < 1.5 &&
                   motors != FakeFalcon::Motors{};
        });
    };
    for (const dvec3& world_n : {dvec3(1, 0, 0), dvec3(0, 2, 0), dvec3(0, 0, 2.5), dvec3(-1, 1, -1)}) {
        const dvec3 device_n(world_n.x, world_n.z, -world_n.y);
        CHECK(near(world_n, expected_counts(device_n, place_of(encoders_at(place_m)))));
    }
    // 30 N along y are 7 N.
    CHECK(near({0, 30, 0}, expected_counts({0, 0, -7}, place_of(encoders_at(place_m)))));

    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (const dvec3& bad : {dvec3(nan, 0, 0), dvec3(0, infinity, 1), dvec3(1e300, 1e300, nan)}) {
        CHECK(near({1, 0, 0}, expected_counts({1, 0, 0}, place_of(encoders_at(place_m)))));
        CHECK(holds(device, falcon, bad, {}));
    }
    CHECK(falcon.violations() == 0);
}

TEST_CASE("reading and writing allocate nothing, ready or not")
{
    FakeFalcon falcon(false, 20);
    FalconDevice device("falcon", open_fake(falcon), quick_options());
    uint64_t allocations = 0;
    int ready = 0, others = 0;
    for (int tick = 0; tick < 600 && ready < 300; ++tick) {
        if (ready == 150) falcon.inject(FakeFault::garbage, 0, 100);
        DevicePose pose;
        const uint64_t before = allocations_of_this_thread();
        const DeviceStatus status = device.read(pose);
        device.write({0, 0, 1}, dvec3(0));
        allocations += allocations_of_this_thread() - before;
        ++(status == DeviceStatus::ok ? ready : others);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(allocations == 0);
    CHECK(ready >= 200);
    CHECK(others > 0);
}

TEST_CASE("a servo that falls silent loses its force, is told so, and may go on")
{
    FakeFalcon falcon(true);
    FalconOptions options = quick_options();
    options.times.watchdog_ms = 60;
    FalconDevice device("falcon", open_fake(falcon), options);
    REQUIRE(becomes(device, DeviceStatus::ok));
    REQUIRE(tick_until(device, {0, 0, 2}, [&](DeviceStatus) { return falcon.motors() != FakeFalcon::Motors{}; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(falcon.motors() == FakeFalcon::Motors{});
    CHECK(falcon.flags() == falcon_green);
    CHECK(device.counters().dropped >= 1);
    DevicePose pose;
    REQUIRE(device.read(pose) == DeviceStatus::ok);
    CHECK(pose.interrupted);
    CHECK(tick_until(device, {0, 0, 2}, [&](DeviceStatus) { return falcon.motors() != FakeFalcon::Motors{}; }));
}

TEST_CASE("stop() and the destructor leave the motors without force")
{
    FakeFalcon falcon(true);
    {
        FalconDevice device("falcon", open_fake(falcon), quick_options());
        REQUIRE(becomes(device, DeviceStatus::ok));
        const auto pushes = [&](DeviceStatus) { return falcon.motors() != FakeFalcon::Motors{}; };
        REQUIRE(tick_until(device, {0, 0, 2}, pushes));
        device.stop();
        CHECK(holds(device, falcon, {0, 0, 2}, {}));
        for (int i = 0; i < 50; ++i) {
            device.write({0, 0, 2}, dvec3(0));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        CHECK(falcon.motors() == FakeFalcon::Motors{});
    }
    {
        FalconDevice device("falcon", open_fake(falcon), quick_options());
        REQUIRE(tick_until(device, {0, 0, 2}, [&](DeviceStatus) { return falcon.motors() != FakeFalcon::Motors{}; }));
    }
    CHECK(falcon.motors() == FakeFalcon::Motors{});
}

TEST_CASE("unplugged, it is not ready; plugged in again it is loaded and homed, and says that it was interrupted")
{
    FakeFalcon falcon(true);
    FalconDevice device("falcon", open_fake(falcon), quick_options());
    REQUIRE(becomes(device, DeviceStatus::ok));
    falcon.inject(FakeFault::unplug, 0, uint64_t{1} << 60);
    REQUIRE(becomes(device, DeviceStatus::not_ready, {0, 0, 2}));
    REQUIRE(tick_until(device, {0, 0, 2},
                       [&](DeviceStatus) { return device.state().find("0403:cb48") != std::string::npos; }));
    const uint64_t before = falcon.packets_with_force();
    falcon.plug_in();
    DevicePose pose;
    bool homed = false;
    for (int i = 0; i < 5000 && !homed; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        homed = device.read(pose) == DeviceStatus::ok;
        if (!homed) device.write({0, 0, 2}, dvec3(0));
    }
    REQUIRE(homed);
    CHECK(pose.interrupted);
    CHECK(falcon.packets_with_force() == before);
    CHECK(falcon.violations() == 0);
    REQUIRE(device.read(pose) == DeviceStatus::ok);
    CHECK(!pose.interrupted);
}

TEST_CASE("one that stays away is disconnected, one that cannot be loaded is a fault, and both say why")
{
    FakeFalcon away(true);
    FalconOptions impatient = quick_options();
    impatient.patience_s = 0.05;
    away.inject(FakeFault::unplug, 0, uint64_t{1} << 60);
    FalconDevice absent("falcon", open_fake(away), impatient);
    CHECK(becomes(absent, DeviceStatus::disconnected));
    CHECK(absent.state() == "no USB device 0403:cb48 is connected");

    FakeFalcon empty(false);
    FalconOptions no_firmware = quick_options();
    no_firmware.firmware.clear();
    FalconDevice unloaded("falcon", open_fake(empty), no_firmware);
    CHECK(becomes(unloaded, DeviceStatus::fault));
    CHECK(unloaded.state() ==
          "the Falcon cannot be used: it runs no program, and there is no firmware to load: put Novint's "
          "nvent_firmware.bin at ~/.config/haptel/falcon_firmware.bin, or name it in HAPTEL_FALCON_FIRMWARE");

    FakeFalcon broken(false);
    broken.inject(FakeFault::wrong_bytes, 0, uint64_t{1} << 60);
    FalconDevice unloadable("falcon", open_fake(broken), quick_options());
    CHECK(becomes(unloadable, DeviceStatus::fault));
    CHECK(unloadable.state() ==
          "the Falcon cannot be used: its boot loader does not answer. Take its power and its USB "
          "away for a moment");
    CHECK(unloadable.write({0, 0, 1}, dvec3(0)) == DeviceStatus::fault);
}
