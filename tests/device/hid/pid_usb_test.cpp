// An OpenFFBoard made of bytes over the real libusb. The kernel's part is played by usbfs_shim.cpp.
#include "device/hid/open_hid.h"
#include "device/usb/usb_transport.h"
#include "tests/device/hid/board_exchange.h"
#include "tests/device/hid/board_ticks.h"
#include "tests/device/usb/usbfs_shim.h"
#include "tests/support/catch.h"

#include <optional>
#include <random>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

using BusClock = std::chrono::steady_clock;

double passed_s(BusClock::time_point start)
{
    return std::chrono::duration<double>(BusClock::now() - start).count();
}

constexpr PidTimes pid_on_a_bus{.transfer_ms = 100, .load_ms = 200, .poll_ms = 1};

OpenAxes open_on_bus(const UsbfsShim& shim)
{
    const OpenInterface open = [fd = shim.file_descriptor()](int number) {
        return open_usb(fd, UsbInterface{number, EndpointKind::interrupt});
    };
    return [open] { return open_pid_axes(open, openffboard_interface, pid_on_a_bus); };
}

struct BoardOnBus {
    FakeBoard fake;
    UsbfsShim shim{fake};
    std::optional<AxisDevice> device;

    explicit BoardOnBus(const AxisTimes& times = quick_axes)
    {
        device.emplace("openffboard", open_on_bus(shim), board_settings, times);
    }
    bool pushes_until(const glm::dvec3& force_n, const std::function<bool()>& happens)
    {
        return ticks_until(*device, force_n, [&](auto, auto&) { return happens(); });
    }
};

void exchange_with_board(double seconds)
{
    const auto start = BusClock::now();
    BoardOnBus board;
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    const double ready_s = passed_s(start);
    const BoardExchange done = exchange(*board.device, board.fake, board_settings.force_max_n, seconds);
    WARN("ready after " << ready_s << " s; " << in_words(done));
    CHECK(done.worst_counts <= 1);
    CHECK(done.poses == done.ticks);
    CHECK(done.forces > 20 * done.seconds); // a busy machine lets the newest command replace most
    CHECK(board.fake.mistakes() == std::vector<std::string>{});
    board.device.reset();
    CHECK(board.fake.magnitude(0) == 0);
    CHECK(!board.fake.active());
}

void board_faults_over_libusb(uint32_t runs)
{
    constexpr std::array faults = {BoardFault::stall,       BoardFault::garbage,    BoardFault::short_reports,
                                   BoardFault::full,        BoardFault::slow_block, BoardFault::silence,
                                   BoardFault::wrong_block, BoardFault::none};
    double longest_s = 0;
    for (uint32_t seed = 1; seed <= runs; ++seed) {
        std::mt19937 random(seed);
        const BoardFault fault = faults[random() % faults.size()]; // none: unplugged
        CAPTURE(seed, static_cast<int>(fault));
        const auto start = BusClock::now();
        BoardOnBus board;
        AxisTimes times = quick_axes;
        times.patience_s = 60;
        board.device.reset();
        board.fake.inject(fault, random() % 150, random() % 2 == 0 ? 1 + random() % 60 : uint64_t{1} << 60);
        board.device.emplace("openffboard", open_on_bus(board.shim), board_settings, times);
        int ticks = 0;
        board.pushes_until({9, 0, 0}, [&] { return ++ticks == 80; });
        if (fault == BoardFault::none) board.fake.plug(false);
        board.pushes_until({9, 0, 0}, [&] { return ++ticks == 160; });
        board.fake.inject(BoardFault::none, 0, 0);
        board.fake.plug(true);
        board.fake.turn_to(0, 0);
        CHECK(becomes(*board.device, DeviceStatus::ok));
        board.device.reset();
        CHECK(board.fake.magnitude(0) == 0);
        CHECK(!board.fake.active());
        CHECK(passed_s(start) < 15);
        longest_s = std::max(longest_s, passed_s(start));
    }
    WARN(runs << " runs, the longest " << longest_s << " s");
}

} // namespace

TEST_CASE("an OpenFFBoard over libusb is brought up and pushed at 1 kHz, with the forces as commanded")
{
    exchange_with_board(2);
}

TEST_CASE("an OpenFFBoard over libusb for a minute", "[.soak]")
{
    exchange_with_board(60);
}

TEST_CASE("a board that takes nothing more is given up, and closing it is bounded")
{
    BoardOnBus board;
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    board.shim.hold_out(true);
    auto start = BusClock::now();
    CHECK(ticks_until(*board.device, {9, 0, 0}, [](DeviceStatus status, auto&) { return status != DeviceStatus::ok; }));
    CHECK(passed_s(start) < 3);
    CHECK(board.pushes_until({9, 0, 0}, [&] {
        return board.device->state().find("takes no forces") != std::string::npos ||
               board.device->state().find("Device Reset: no answer in time") != std::string::npos;
    }));
    start = BusClock::now();
    board.device.reset();
    CHECK(passed_s(start) < 3);
}

TEST_CASE("a board unplugged from libusb is not ready at once, and comes back when it is plugged in")
{
    BoardOnBus board;
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    board.fake.plug(false);
    const auto start = BusClock::now();
    REQUIRE(becomes(*board.device, DeviceStatus::not_ready));
    const double noticed_s = passed_s(start);
    CHECK(board.pushes_until({9, 0, 0}, [&] {
        return board.device->state().find("unplugged") != std::string::npos ||
               board.device->state().find("no USB device") != std::string::npos;
    }));
    board.fake.plug(true);
    CHECK(becomes(*board.device, DeviceStatus::ok));
    WARN("noticed after " << noticed_s << " s, back after " << passed_s(start) << " s");
    CHECK(noticed_s < 1);
}

TEST_CASE("open_hid takes a file descriptor, and finds the interface that can be pushed")
{
    FakeBoard fake;
    UsbfsShim shim(fake);
    DeviceRequest request;
    request.name = "hid:1209:ffb0";
    const DeviceResult result = open_hid(request, shim.file_descriptor(), 0, {});
    REQUIRE(result.error == "");
    CHECK(result.device->info().axes.pushes == glm::bvec3(true, true, false));
    DevicePose pose;
    for (int i = 0; i < 8000 && result.device->read(pose) != DeviceStatus::ok; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(result.device->read(pose) == DeviceStatus::ok);
    fake.inject(BoardFault::bad_descriptor, 0, 1'000'000);
    CHECK(open_hid(request, shim.file_descriptor(), 2, {}).error ==
          "the device cannot be pushed: its report descriptor cannot be read: it is cut off. If Linux can push it, "
          "open its file: evdev:FILE");
}

TEST_CASE("faults of a board over libusb end with a pose again, and without force in the end")
{
    board_faults_over_libusb(16);
}

TEST_CASE("faults of a board over libusb, a thousand times", "[.long]")
{
    board_faults_over_libusb(1000);
}
