// What becomes of the force when the process that pushes a device is killed or stopped, by the kernel's hand and by
// that of the guard, and what the next process finds.
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/hid/board_ticks.h"
#include "tests/device/usb/usbip_port.h"
#include "tests/device/vm/comes.h"
#include "tests/device/vm/open_by_name.h"
#include "tests/device/vm/uinput_wheel.h"
#include "tests/support/catch.h"

#include <csignal>
#include <cstdlib>
#include <sys/wait.h>
#include <unistd.h>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

constexpr const char* pushing_case = "push a device until killed";
constexpr const char* device_variable = "HAPTEL_VM_PUSHED";

// Another process, of this program, that pushes the device to the right.
class PushingProcess {
public:
    explicit PushingProcess(const std::string& device)
    {
        setenv(device_variable, device.c_str(), 1);
        id_ = fork();
        if (id_ == 0) {
            execl("/proc/self/exe", "vm_tests", pushing_case, nullptr);
            _exit(127);
        }
        unsetenv(device_variable);
    }
    ~PushingProcess() { end(); }
    PushingProcess(const PushingProcess&) = delete;
    PushingProcess& operator=(const PushingProcess&) = delete;

    pid_t id() const { return id_; }
    void stand_still() const { kill(id_, SIGSTOP); }
    void go_on() const { kill(id_, SIGCONT); }
    void end()
    {
        if (id_ <= 0) return;
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
        id_ = 0;
    }

private:
    pid_t id_ = 0;
};

} // namespace

TEST_CASE("push a device until killed", "[.]")
{
    const char* name = std::getenv(device_variable);
    if (!name) return; // started by hand
    const std::unique_ptr<HapticDevice> device = open_by_name(name);
    for (;;) ticks_until(*device, {2, 0, 0}, [](auto, auto&) { return false; });
}

TEST_CASE("a wheel whose process is stopped or killed has no force")
{
    UinputWheel wheel;
    PushingProcess process("evdev:" + wheel.path());
    // a fifth of what it can do, by a motor that is wired the other way round
    REQUIRE(comes([&] { return !wheel.uploads().empty() && wheel.uploads().back().level == -6553; }));
    CHECK(wheel.erased().empty());
    REQUIRE(comes([&] { return wheel.plays().back().value == 1; }));
    process.stand_still();
    CHECK(comes([&] { return wheel.plays().back().value == 0; }));
    process.go_on();
    CHECK(comes([&] { return wheel.plays().back().value == 1 && wheel.uploads().back().level == -6553; }));
    process.end();
    CHECK(comes([&] { return wheel.erased() == std::vector<int>{wheel.uploads().back().id}; }));
    CHECK(wheel.plays().back().value == 0);
}

TEST_CASE("an OpenFFBoard whose process is stopped or killed has no force, and the next process opens it")
{
    FakeBoard board;
    UsbipPort port(board, "F7");
    PushingProcess process("openffboard:F7");
    REQUIRE(comes([&] { return board.magnitude(0) == 6553; }));
    const std::string refused = why_not_opened("openffboard:F7");
    CAPTURE(refused);
    CHECK(refused.find("in use by") != std::string::npos);
    CHECK(refused.find("(process " + std::to_string(process.id()) + ")") != std::string::npos);
    process.stand_still();
    CHECK(comes([&] { return board.force(0) == 0; }));
    process.go_on();
    REQUIRE(comes([&] { return board.force(0) != 0; }));
    process.end();
    CHECK(comes([&] { return board.force(0) == 0; }));
    CHECK(port.kernel_driver(2) == ""); // nobody gave it back
    std::unique_ptr<HapticDevice> device = open_by_name("openffboard:F7");
    board.turn_to(0, 0);
    CHECK(becomes(*device, DeviceStatus::ok));
    CHECK(ticks_until(*device, no_force, [&](auto, auto&) { return board.force(0) == 0; }));
    device.reset();
    CHECK(comes([&] { return port.kernel_driver(2) == "usbhid"; }));
    CHECK(board.mistakes() == std::vector<std::string>{});
}

TEST_CASE("a Falcon whose process is stopped or killed has no force, and runs its program still")
{
    FakeFalcon falcon(true);
    UsbipPort port(falcon, "A42");
    PushingProcess process("falcon:A42");
    const auto pushes = [&] { return falcon.motors() != FakeFalcon::Motors{}; };
    REQUIRE(comes(pushes));
    process.stand_still();
    CHECK(comes([&] { return !pushes(); }));
    process.go_on();
    REQUIRE(comes(pushes));
    process.end();
    CHECK(comes([&] { return !pushes(); }));
    const std::unique_ptr<HapticDevice> device = open_by_name("falcon:A42");
    CHECK(becomes(*device, DeviceStatus::ok));
    CHECK(falcon.image().empty());
    CHECK(falcon.violations() == 0);
}
