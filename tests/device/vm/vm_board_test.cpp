// An OpenFFBoard on the real kernel's USB: taken from the kernel's driver by ours, and left to the kernel's own
// (hid-pidff), which ours for wheels stands upon.
#include "tests/device/hid/board_exchange.h"
#include "tests/device/hid/board_ticks.h"
#include "tests/device/usb/usbip_port.h"
#include "tests/device/vm/comes.h"
#include "tests/device/vm/open_by_name.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

namespace fs = std::filesystem;

constexpr double strongest_n = 20;
const std::string settings = ",travel_m=0.4,force_max_n=20";

// "/dev/input/event3"; empty: the kernel has made none.
std::string input_file(const UsbipPort& port)
{
    std::error_code vanished;
    for (fs::recursive_directory_iterator each(port.in_sysfs(), vanished), end; each != end; each.increment(vanished)) {
        const std::string file = "/dev/input/" + each->path().filename().string();
        if (file.starts_with("/dev/input/event") && fs::exists(file)) return file;
    }
    return {};
}

// Away from the user is towards smaller values of a stick's y.
bool pushes_away(HapticDevice& device, const FakeBoard& board)
{
    return ticks_until(device, {0, strongest_n / 4, 0},
                       [&](auto, auto&) { return std::fabs(board.force(1) + 0.25) < 1e-4 && board.force(0) == 0; });
}

} // namespace

TEST_CASE("an OpenFFBoard is taken from the kernel's driver, pushed with the forces as commanded, and given back")
{
    FakeBoard board;
    UsbipPort port(board, "F7");
    REQUIRE(comes([&] { return port.kernel_driver(2) == "usbhid" && !input_file(port).empty(); }));
    const auto listed = listed_devices();
    CHECK(std::ranges::count(listed, "openffboard:F7", &ListedDevice::name) == 1);
    std::unique_ptr<HapticDevice> device = open_by_name("openffboard:F7" + settings);
    REQUIRE(becomes(*device, DeviceStatus::ok));
    CHECK(port.kernel_driver(2) == "usbfs");
    const BoardExchange done = exchange(*device, board, strongest_n, exchange_seconds());
    WARN("OpenFFBoard: " << in_words(done));
    CHECK(done.worst_counts <= 1);
    CHECK(done.forces > 0); // how many is the emulator's: two effects take turns, and the newest replace some
    CHECK(pushes_away(*device, board));
    device.reset();
    CHECK(board.magnitude(0) == 0);
    CHECK(board.force(0) == 0);
    CHECK(board.force(1) == 0);
    CHECK(comes([&] { return port.kernel_driver(2) == "usbhid"; }));
    CHECK(board.mistakes() == std::vector<std::string>{});
}

TEST_CASE("an OpenFFBoard that is unplugged from the kernel's USB is missed at once, and found when it is back")
{
    FakeBoard board;
    std::optional<UsbipPort> port(std::in_place, board, "F7");
    std::unique_ptr<HapticDevice> device = open_by_name("openffboard:F7" + settings);
    REQUIRE(becomes(*device, DeviceStatus::ok));
    const auto start = std::chrono::steady_clock::now();
    port.reset();
    CHECK(becomes(*device, DeviceStatus::not_ready));
    WARN("OpenFFBoard: unplugging and noticing took "
         << std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() << " s");
    CHECK(comes([&] { return device->state().find("with the serial number 'F7'") != std::string::npos; }));
    board.plug(false); // without power it forgets
    board.plug(true);
    port.emplace(board, "F7");
    CHECK(becomes(*device, DeviceStatus::ok));
    CHECK(ticks_until(*device, {strongest_n / 2, 0, 0}, [&](auto, auto&) { return board.force(0) != 0; }));
    CHECK(board.mistakes() == std::vector<std::string>{});
}

TEST_CASE("the kernel's driver of the class PID and ours for wheels agree on the forces of an OpenFFBoard")
{
    FakeBoard board;
    UsbipPort port(board, "F7");
    REQUIRE(comes([&] { return !input_file(port).empty(); }));
    const std::string name = "evdev:" + input_file(port);
    const auto listed = listed_devices();
    CHECK(std::ranges::count(listed, name, &ListedDevice::name) == 1);
    std::unique_ptr<HapticDevice> device = open_by_name(name + settings);
    REQUIRE(becomes(*device, DeviceStatus::ok));
    const BoardExchange done = exchange(*device, board, strongest_n, exchange_seconds());
    WARN("OpenFFBoard by hid-pidff: " << in_words(done));
    CHECK(done.worst_counts <= 1);
    CHECK(done.forces > 20 * done.seconds);
    CHECK(pushes_away(*device, board));
    device.reset();
    CHECK(comes([&] { return board.force(0) == 0 && board.force(1) == 0; }));
    CHECK(board.mistakes() == std::vector<std::string>{});
}
