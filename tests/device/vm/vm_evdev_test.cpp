// The driver of wheels and sticks on files of the real kernel. What comes out of them on the other side is a uinput
// device's to tell.
#include "device/evdev/input_port.h"
#include "tests/device/hid/board_ticks.h"
#include "tests/device/vm/as_nobody.h"
#include "tests/device/vm/comes.h"
#include "tests/device/vm/open_by_name.h"
#include "tests/device/vm/uinput_wheel.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <linux/input.h>
#include <optional>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

using Plays = std::vector<UinputWheel::Play>;

} // namespace

TEST_CASE("a file of the kernel's is read for its axis and told its forces, and has none when it is closed")
{
    UinputWheel wheel;
    wheel.turn_to(400);
    OpenedInput opened = open_input_port(wheel.path());
    REQUIRE(opened.error == "");
    InputPort& port = *opened.port;
    CHECK(port.has_constant_force());
    REQUIRE(port.axis(0));
    CHECK(port.axis(0)->minimum == UinputWheel::minimum);
    CHECK(port.axis(0)->maximum == UinputWheel::maximum);
    CHECK(port.axis(0)->value == 400);
    CHECK(!port.axis(1));

    wheel.turn_to(-77);
    std::vector<AxisEvent> events;
    CHECK(comes([&] { return port.read(events, 0) != 0 || !events.empty(); }));
    REQUIRE(events.size() == 1);
    CHECK(events[0].axis == 0);
    CHECK(events[0].value == -77);

    CHECK(port.prepare() == 0);
    CHECK(comes([&] { return wheel.gain() == 0xffff; }));
    CHECK(port.set_level(0, 0.5) == 0);
    REQUIRE(wheel.uploads().size() == 1);
    const UinputWheel::Upload made = wheel.uploads()[0];
    CHECK(made.type == FF_CONSTANT);
    CHECK(made.level == 16384); // 16383.5
    CHECK(made.direction == 0x4000);
    CHECK((made.length_ms == 0 || made.length_ms == 0xffff));
    CHECK(wheel.plays().empty());
    CHECK(port.play(0) == 0);
    CHECK(comes([&] { return wheel.plays() == Plays{{made.id, 1}}; }));
    CHECK(port.set_level(0, -1) == 0);
    REQUIRE(wheel.uploads().size() == 2);
    CHECK(wheel.uploads()[1].id == made.id);
    CHECK(wheel.uploads()[1].level == -32767);
    CHECK(wheel.erased().empty());

    opened.port.reset();
    CHECK(comes([&] { return wheel.erased() == std::vector<int>{made.id}; }));
    CHECK(wheel.plays().back() == UinputWheel::Play{made.id, 0});
}

TEST_CASE("a wheel of the kernel's is listed, nudged, pushed the right way round, and missed when it is unplugged")
{
    std::optional<UinputWheel> wheel(std::in_place);
    const std::string name = "evdev:" + wheel->path();
    const auto listed = listed_devices();
    const auto found = std::ranges::find(listed, name, &ListedDevice::name);
    REQUIRE(found != listed.end());
    CHECK(found->what == "a wheel of uinput");
    CHECK(found->refused.empty());
    std::unique_ptr<HapticDevice> device = open_by_name(name + ",travel_m=0.4,force_max_n=20");
    REQUIRE(becomes(*device, DeviceStatus::ok));
    // To the right; the motor is wired the other way round, so a negative level does that.
    CHECK(ticks_until(*device, {5, 0, 0}, [&](auto, auto&) { return wheel->uploads().back().level == -8192; }));
    wheel->turn_to(2000); // three quarters of the way
    CHECK(ticks_until(*device, no_force,
                      [](auto, const DevicePose& pose) { return std::abs(pose.tip_m.x - 0.1) < 1e-3; }));
    wheel.reset();
    CHECK(becomes(*device, DeviceStatus::not_ready));
    CHECK(comes([&] { return device->state().find("is not there") != std::string::npos; }));
}

TEST_CASE("a user who may not open a wheel is told of the group")
{
    UinputWheel wheel;
    const std::string said = as_nobody([&] { return why_not_opened("evdev:" + wheel.path()); });
    CAPTURE(said);
    CHECK(said.find("group `input`") != std::string::npos);
}
