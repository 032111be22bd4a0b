// The driver over the real libusb. The kernel's part is played by usbfs_shim.cpp.
#include "device/falcon/open_falcon.h"
#include "device/usb/usb_devices.h"
#include "device/usb/usb_transport.h"
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/falcon/falcon_exchange.h"
#include "tests/device/falcon/quick_falcon.h"
#include "tests/device/usb/usbfs_shim.h"
#include "tests/support/catch.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <time.h>

using namespace haptel::device;
using namespace haptel::runtime;
using glm::dvec3;

namespace {

using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point start)
{
    return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

OpenTransport open_shim(const UsbfsShim& shim)
{
    return [fd = shim.file_descriptor()] { return open_usb(fd, UsbInterface{}); };
}

FalconOptions options_on_a_bus()
{
    FalconOptions options = quick_options();
    options.bring_up = {.probes = 2, .calls = 10, .reads = 25, .transfer_ms = 100, .seconds = 10};
    return options;
}

void exchange_for(double seconds)
{
    FakeFalcon falcon(false, 50);
    UsbfsShim shim(falcon);
    const auto start = SteadyClock::now();
    FalconDevice device("falcon", open_shim(shim), options_on_a_bus());
    REQUIRE(tick_until(device, dvec3(0), [](DeviceStatus status) { return status == DeviceStatus::ok; }));
    const double ready_s = seconds_since(start);
    CHECK(falcon.image() == synthetic_firmware(50));

    const Exchange done = exchange(device, falcon, seconds);
    WARN("ready after " << ready_s << " s; " << in_words(done));
    CHECK(done.replies >= 0.99 * done.sent);
    CHECK(done.poses > 0.9 * done.ticks); // of a busy machine
    CHECK(done.sent > 0.3 * done.ticks);  // a busy machine lets the newest command replace some
    CHECK(done.worst_counts <= 1);
    CHECK(done.malformed == 0);
    CHECK(falcon.violations() == 0);
}

} // namespace

TEST_CASE("devices that are not there are told of in words")
{
    const UsbList list = list_falcons();
    CHECK((list.error.empty() || list.error.find("/dev/bus/usb") != std::string::npos));
    const DeviceResult result = open_falcon(DeviceRequest{}, "no such serial number");
    CHECK(!result.device);
    CHECK((result.error.find("serial number 'no such serial number'") != std::string::npos ||
           result.error.find("this system gives no access to USB") != std::string::npos));
    CHECK(open_usb(-1, UsbInterface{}).error.find("file descriptor -1 is no USB device") != std::string::npos);
}

TEST_CASE("transfers come back within their time limit, with what went wrong")
{
    FakeFalcon falcon(true);
    UsbfsShim shim(falcon);
    OpenedTransport opened = open_usb(shim.file_descriptor(), UsbInterface{});
    REQUIRE(opened.error == "");
    Transport& transport = *opened.transport;
    std::array<uint8_t, 64> bytes{};
    CHECK(transport.control({0x40, 9, 1, 0}, {}, 100).error == UsbError::none);
    CHECK(transport.in(0x81, bytes, 100).bytes == 2);

    falcon.inject(FakeFault::stall, 0, 3);
    CHECK(transport.control({0x40, 9, 1, 0}, {}, 100).error == UsbError::stall);
    CHECK(transport.out(0x02, bytes, 100).error == UsbError::stall);
    CHECK(transport.in(0x81, bytes, 100).error == UsbError::stall);

    shim.hold_out(true);
    const auto start = SteadyClock::now();
    CHECK(transport.out(0x02, bytes, 50).error == UsbError::timeout);
    CHECK(seconds_since(start) > 0.04);
    CHECK(seconds_since(start) < 2);
    shim.hold_out(false);

    falcon.inject(FakeFault::unplug, 0, 1);
    CHECK(transport.control({0x40, 9, 1, 0}, {}, 100).error == UsbError::gone);
    CHECK(transport.out(0x02, bytes, 100).error == UsbError::gone);
    CHECK(transport.in(0x81, bytes, 100).error == UsbError::gone);
}

TEST_CASE("a Falcon over libusb is loaded, homed and exchanges packets at 1 kHz, with the forces as commanded")
{
    exchange_for(3);
}

TEST_CASE("a Falcon over libusb for a minute", "[.soak]")
{
    exchange_for(60);
}

TEST_CASE("a device that takes nothing more is given up, and closing it is bounded")
{
    FakeFalcon falcon(true);
    UsbfsShim shim(falcon);
    std::optional<FalconDevice> device(std::in_place, "falcon", open_shim(shim), options_on_a_bus());
    REQUIRE(tick_until(*device, dvec3(0), [](DeviceStatus status) { return status == DeviceStatus::ok; }));
    shim.hold_out(true);
    CHECK(tick_until(*device, {0, 0, 1}, [](DeviceStatus status) { return status == DeviceStatus::not_ready; }));
    CHECK(tick_until(*device, {0, 0, 1}, [&](DeviceStatus) { return device->counters().out_failed > 0; }));
    const auto start = SteadyClock::now();
    device.reset();
    CHECK(seconds_since(start) < 3);
}

TEST_CASE("unplugged from libusb it is not ready at once, and comes back when it is plugged in")
{
    FakeFalcon falcon(true);
    UsbfsShim shim(falcon);
    FalconDevice device("falcon", open_shim(shim), options_on_a_bus());
    REQUIRE(tick_until(device, dvec3(0), [](DeviceStatus status) { return status == DeviceStatus::ok; }));
    falcon.inject(FakeFault::unplug, 0, 1);
    const auto start = SteadyClock::now();
    REQUIRE(tick_until(device, {0, 0, 1}, [](DeviceStatus status) { return status == DeviceStatus::not_ready; }));
    const double noticed_s = seconds_since(start);
    REQUIRE(tick_until(device, {0, 0, 1},
                       [&](DeviceStatus) { return device.state().find("unplugged") != std::string::npos; }));
    const uint64_t before = falcon.packets_with_force();
    falcon.plug_in();
    DevicePose pose;
    for (int i = 0; i < 5000 && device.read(pose) != DeviceStatus::ok; ++i) {
        device.write({0, 0, 1}, dvec3(0));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(pose.interrupted);
    CHECK(falcon.packets_with_force() == before);
    CHECK(device.write({0, 0, 1}, dvec3(0)) == DeviceStatus::ok);
    WARN("noticed after " << noticed_s << " s, back after " << seconds_since(start) << " s");
    CHECK(noticed_s < 1);
}

TEST_CASE("open_falcon takes a file descriptor and a firmware file")
{
    const auto file = std::filesystem::temp_directory_path() / "haptel_usb_test_firmware.bin";
    const auto image = synthetic_firmware(20);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
    FakeFalcon falcon(false);
    UsbfsShim shim(falcon);
    DeviceRequest request;
    request.name = "falcon";
    {
        const DeviceResult result = open_falcon(request, shim.file_descriptor(), file);
        REQUIRE(result.error == "");
        DevicePose pose;
        for (int i = 0; i < 8000 && result.device->read(pose) != DeviceStatus::ok; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        CHECK(result.device->read(pose) == DeviceStatus::ok);
        CHECK(falcon.image() == image);
    }
    CHECK(falcon.motors() == FakeFalcon::Motors{});
    std::filesystem::remove(file);
}

namespace {

void faults_over_libusb(uint32_t runs)
{
    double longest_s = 0;
    for (uint32_t seed = 1; seed <= runs; ++seed) {
        std::mt19937 random(seed);
        const FakeFault fault = all_fake_faults[random() % all_fake_faults.size()];
        INFO("seed " << seed << ": " << name_of(fault));
        FakeFalcon falcon(random() % 2 == 0, 2);
        UsbfsShim shim(falcon);
        FalconOptions options = options_on_a_bus();
        options.firmware = synthetic_firmware(20);
        options.times.silence_ms = 50;
        options.pose_age_max_ms = 30;
        options.tries = 100;
        falcon.inject(fault, random() % 200, random() % 2 == 0 ? 1 + random() % 60 : uint64_t{1} << 60);
        const auto start = SteadyClock::now();
        {
            FalconDevice device("falcon", open_shim(shim), options);
            int ticks = 0;
            tick_until(device, {0, 0, 1}, [&](DeviceStatus) { return ++ticks == 80; });
            falcon.inject(FakeFault::none, 0, 0);
            if (fault == FakeFault::unplug) falcon.plug_in();
            CHECK(tick_until(device, {0, 0, 1}, [](DeviceStatus status) { return status == DeviceStatus::ok; }));
        }
        CHECK(falcon.motors() == FakeFalcon::Motors{});
        CHECK(falcon.violations() == 0);
        CHECK(seconds_since(start) < 15);
        longest_s = std::max(longest_s, seconds_since(start));
    }
    WARN(runs << " runs, the longest " << longest_s << " s");
}

} // namespace

TEST_CASE("faults over libusb end with a pose again, and without force in the end")
{
    faults_over_libusb(40);
}

TEST_CASE("faults over libusb, two thousand times", "[.long]")
{
    faults_over_libusb(2000);
}
