// haptel devices with devices on the USB, each found, opened or refused: what the user reads says what was found,
// where, and what to do about it.
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/falcon/firmware_image.h"
#include "tests/device/hid/fake_board.h"
#include "tests/device/usb/usb_bus.h"
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

using namespace haptel::device;
using namespace haptel::test;

namespace {

// A user who is not root, whoever runs the tests.
std::string as_user()
{
    return geteuid() == 0 ? "setpriv --bounding-set=-dac_override,-dac_read_search" : "";
}

std::string with_firmware(const std::string& file)
{
    return "HAPTEL_FALCON_FIRMWARE='" + file + "'";
}

std::string firmware_in(const Folder& folder, const std::vector<uint8_t>& image)
{
    return with_firmware(folder.write("firmware.bin", {reinterpret_cast<const char*>(image.data()), image.size()}));
}

// Opens it until it says all of that, and longer where this machine is too busy to come to that in time.
Ran open_says(const std::string& name, std::initializer_list<std::string> parts, const std::string& before = "")
{
    Ran ran;
    std::string missing = "all";
    for (int seconds = 2; seconds < 60 && !missing.empty(); seconds *= 5) {
        ran = run_command("devices --open " + name + " --seconds " + std::to_string(seconds), before);
        const auto part = std::ranges::find_if(parts, [&](auto& each) { return !contains(ran.out + ran.err, each); });
        missing = part == parts.end() ? "" : *part;
    }
    CAPTURE(ran.out, ran.err);
    CHECK(missing.empty());
    return ran;
}

// `haptel devices --open NAME` beside what this program does, until it is interrupted.
class Running {
public:
    explicit Running(const char* name) : process_(fork())
    {
        if (process_ != 0) return;
        execl(HAPTEL_COMMAND, HAPTEL_COMMAND, "devices", "--open", name, "--seconds", "60", nullptr);
        _exit(1);
    }
    ~Running()
    {
        kill(process_, SIGTERM);
        waitpid(process_, nullptr, 0);
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    std::string name() const { return "haptel (process " + std::to_string(process_) + ")"; }

private:
    pid_t process_;
};

} // namespace

TEST_CASE("devices: nothing is on the USB")
{
    const UsbBus bus;
    const Ran list = run_command("devices");
    CHECK(list.code == 0);
    CHECK(list.out.find("connected\n  nothing that haptel knows\nsupported") == 0);
    open_says("falcon", {"device 'falcon'", "no USB device 0403:cb48 is connected: plug it in and switch it on"});
    open_says("falcon:A", {"0403:cb48 with the serial number 'A' is connected: plug it in"});
    open_says("openffboard", {"no USB device 1209:ffb0 is connected: plug it in"});
    open_says("hid:1234:abcd", {"no USB device 1234:abcd is connected: plug it in"});
}

TEST_CASE("devices: each on the USB is listed by the name that opens it")
{
    FakeFalcon first(true), second(true);
    FakeBoard board;
    UsbBus bus;
    bus.plug(first, 2, "FALCON-A");
    bus.plug(second, 3, "");
    bus.plug(board, 4, "1234", "usbhid");
    const Ran list = run_command("devices");
    CHECK(list.code == 0);
    CHECK(contains(list.out, "  falcon:FALCON-A            Novint Falcon, USB bus 1 device 2\n"));
    CHECK(contains(list.out, "  falcon                     Novint Falcon, USB bus 1 device 3\n"));
    CHECK(contains(list.out, "  openffboard:1234           OpenFFBoard, USB bus 1 device 4\n"));

    open_says("falcon:B", {"there are 'FALCON-A', one without"});
    const std::string moved = "senses xy, pushes xy, at most 10 N\n  readings",
                      range = "mm along x, y, z"; // when nudged
    CHECK(open_says("openffboard:1234", {"openffboard:1234: " + moved, range}).code == 0);
    CHECK(open_says("hid:1209:ffb0", {"hid:1209:ffb0: " + moved, range}).code == 0);
    CHECK(bus.kernel_has(4));
    CHECK(board.mistakes().empty());
    // It answers, and nobody moves it.
    open_says("falcon:FALCON-A", {"move it while this looks"});
    CHECK(first.packets() > 0);
    CHECK(second.packets() == 0);
    CHECK(first.packets_with_force() == 0);
}

TEST_CASE("devices: what this user may not open is listed, with the rule that is missing")
{
    FakeFalcon falcon(true);
    FakeBoard board;
    UsbBus bus;
    bus.plug(falcon, 2, "FALCON-A");
    bus.plug(board, 3, "1234");
    bus.forbid(2);
    bus.forbid(3);
    const Ran list = run_command("devices", as_user());
    CHECK(list.code == 0);
    CHECK(
        contains(list.out, "USB device 0403:cb48 (bus 1, device 2): no permission to open it. Install the udev rule"));
    CHECK(
        contains(list.out, "USB device 1209:ffb0 (bus 1, device 3): no permission to open it. Install the udev rule"));
    for (const char* name : {"falcon", "openffboard"})
        open_says(name,
                  {"no permission to open it", "device/udev/60-haptel.rules", "udevadm control --reload",
                   "plug the device in"},
                  as_user());
}

TEST_CASE("devices: what another program holds is listed, with that program's name")
{
    FakeFalcon falcon(true);
    UsbBus bus;
    bus.plug(falcon, 2, "FALCON-A");
    {
        const Running other("falcon");
        for (int i = 0; i < 2000 && falcon.packets() == 0; ++i) usleep(5000);
        REQUIRE(falcon.packets() > 0);
        const Ran list = run_command("devices");
        CAPTURE(list.out);
        CHECK(contains(list.out, "  falcon:FALCON-A "));
        CHECK(contains(list.out, "(bus 1, device 2): in use by " + other.name() + ". Close that first"));
        open_says("falcon", {"in use by", other.name(), "Close that first"});
    }
    CHECK(!contains(run_command("devices").out, "in use by"));
}

TEST_CASE("devices: one that is interrupted while it nudges leaves no force behind")
{
    FakeBoard board;
    UsbBus bus;
    bus.plug(board, 2, "");
    board.hold(0, true);
    {
        const Running nudging("openffboard");
        for (int i = 0; i < 10'000 && board.magnitude(0) == 0; ++i) usleep(1000);
        REQUIRE(board.magnitude(0) != 0);
    }
    CHECK(board.magnitude(0) == 0);
    CHECK(!bus.is_held(2));
}

TEST_CASE("devices: a Falcon without a program says which file it needs, and what is wrong with the one it is given")
{
    const Folder folder;
    const std::vector<uint8_t> image = synthetic_firmware(20);
    FakeFalcon falcon(false);
    UsbBus bus;
    bus.plug(falcon, 2, "");
    const std::string copy = "Copy nvent_firmware.bin of Novint's driver there";
    open_says(
        "falcon",
        {"runs no program", "nvent_firmware.bin", "~/.config/haptel/falcon_firmware.bin", "HAPTEL_FALCON_FIRMWARE"},
        "XDG_CONFIG_HOME='" + folder.path.string() + "'");
    open_says("falcon", {"absent.bin' (No such file or directory)", "HAPTEL_FALCON_FIRMWARE names another"},
              with_firmware(folder.file("absent.bin")));
    open_says("falcon", {"(Is a directory)"}, with_firmware(folder.path.string()));
    open_says("falcon", {"firmware.bin' is no firmware of a Falcon: the image ends in the middle", copy},
              firmware_in(folder, {image.begin(), image.end() - 9}));
    open_says("falcon", {"it begins with 0x0201, not with the boot loader's key 0x08aa", copy},
              firmware_in(folder, {1, 2, 3, 4}));
    open_says("falcon", {"the image is empty", copy}, firmware_in(folder, {}));
    CHECK(falcon.image().empty()); // it saw nothing of them

    open_says("falcon", {"move it while this looks"}, firmware_in(folder, image));
    CHECK(falcon.image() == image);
}

TEST_CASE("devices: a Falcon that is not homed says how to home it, and one that refuses all what to try")
{
    const Folder folder;
    FakeFalcon lost(true, 1'000'000), strange(false);
    UsbBus bus;
    bus.plug(lost, 2, "");
    open_says("falcon", {"s: connected, but its arms do not know where they are", "pull the grip out"});
    bus.unplug(2);
    strange.inject(FakeFault::stall, 0, uint64_t{1} << 60);
    bus.plug(strange, 3, "");
    open_says("falcon",
              {"the Falcon cannot be used: the device refused the request", "Take its power and its USB away"},
              firmware_in(folder, synthetic_firmware(20)));
}

TEST_CASE("devices: a board that is held fast, or whose reports are not understood, says what to try")
{
    FakeFalcon falcon(true);
    FakeBoard board;
    UsbBus bus;
    bus.plug(board, 2, "");
    bus.plug(falcon, 3, "");
    for (const int axis : {0, 1}) board.hold(axis, true);
    open_says("openffboard", {"it does not move when it is nudged: let go of it, and see that its motor is on"});
    board.inject(BoardFault::full, 0, uint64_t{1} << 60);
    open_says("openffboard", {"it has no room for an effect", "plug it in again"});
    board.inject(BoardFault::stall, 0, uint64_t{1} << 60);
    open_says("openffboard", {"does not say what it is", "plug it in again"});
    board.inject(BoardFault::bad_descriptor, 0, uint64_t{1} << 60);
    open_says("openffboard", {"its report descriptor cannot be read", "evdev:FILE"});
    open_says("hid:0403:cb48", {"does not say what it is: the device refused the request"});
    open_says("hid:12:ffb0", {"as `lsusb` tells them: hid:1209:ffb0"});
}
