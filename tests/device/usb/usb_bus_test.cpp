// Which devices are found, which can be opened and what is said of the others: the real libusb looks for them on a USB
// that umockdev makes up.
#include "device/falcon/open_falcon.h"
#include "device/hid/open_hid.h"
#include "device/usb/usb_devices.h"
#include "device/usb/usb_transport.h"
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/falcon/quick_falcon.h"
#include "tests/device/hid/fake_board.h"
#include "tests/device/usb/usb_bus.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <linux/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

using namespace haptel::device;
using namespace haptel::runtime;
using haptel::test::Folder;

namespace {

constexpr UsbInterface falcon_interface{0, EndpointKind::bulk};

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

DeviceRequest request_for(const std::string& name)
{
    DeviceRequest request;
    request.name = name;
    request.rate_hz = 1000;
    return request;
}

// This thread may open what its user may, even if that is root, who may open all.
class WithoutPrivilege {
public:
    WithoutPrivilege()
    {
        REQUIRE(syscall(SYS_capget, &header_, before_) == 0);
        __user_cap_data_struct less[2] = {before_[0], before_[1]};
        less[0].effective &= ~(1u << CAP_DAC_OVERRIDE | 1u << CAP_DAC_READ_SEARCH);
        REQUIRE(syscall(SYS_capset, &header_, less) == 0);
    }
    ~WithoutPrivilege() { syscall(SYS_capset, &header_, before_); }
    WithoutPrivilege(const WithoutPrivilege&) = delete;
    WithoutPrivilege& operator=(const WithoutPrivilege&) = delete;

private:
    __user_cap_header_struct header_{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct before_[2] = {};
};

bool ticks_until(HapticDevice& device, DeviceStatus wanted, const std::string& state = "")
{
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < deadline) {
        DevicePose pose;
        const DeviceStatus status = device.read(pose);
        device.write(glm::dvec3(0), glm::dvec3(0));
        if (status == wanted && contains(device.state(), state)) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

} // namespace

TEST_CASE("on a USB without devices none is listed, and opening one says that it is not connected")
{
    const UsbBus bus;
    CHECK(list_falcons().devices.empty());
    CHECK(list_falcons().error == "");
    CHECK(list_openffboards().devices.empty());
    const DeviceResult falcon = open_falcon(request_for("falcon"), "");
    CHECK(!falcon.device);
    CHECK(contains(falcon.error, "no USB device 0403:cb48 is connected: plug it in"));
    CHECK(contains(open_openffboard("", request_for("openffboard")).error, "no USB device 1209:ffb0 is connected"));
}

TEST_CASE("a Falcon is listed by its serial number and its place, and other devices are not")
{
    FakeFalcon falcon(true);
    FakeBoard board;
    UsbBus bus;
    bus.plug(falcon, 5, "FALCON-A");
    bus.plug(board, 6, "");
    const UsbList list = list_falcons();
    REQUIRE(list.devices.size() == 1);
    CHECK(list.devices[0].serial == "FALCON-A");
    CHECK(list.devices[0].bus == 1);
    CHECK(list.devices[0].address == 5);
    CHECK(list.devices[0].refused.empty());
    CHECK(!bus.is_held(5));
    CHECK(falcon.requests().empty()); // nothing is sent to it
}

TEST_CASE("of two Falcons the one of the serial number is opened")
{
    FakeFalcon first(true), second(true);
    UsbBus bus;
    bus.plug(first, 2, "FALCON-A");
    bus.plug(second, 3, "FALCON-B");
    REQUIRE(list_falcons().devices.size() == 2);
    {
        const OpenedTransport opened = open_usb(falcon_ids, "FALCON-B", falcon_interface);
        REQUIRE(opened.error == "");
        CHECK(bus.is_held(3));
        CHECK(!bus.is_held(2));
        CHECK(opened.transport->control({0x40, 9, 1, 0}, {}, 1000).error == UsbError::none);
    }
    CHECK(!bus.is_held(3));
    CHECK(first.requests().empty());
    CHECK(second.requests().size() == 1);
    const OpenedTransport other = open_usb(falcon_ids, "FALCON-C", falcon_interface);
    CHECK(other.code == UsbError::not_found);
    CHECK(contains(other.error, "with the serial number 'FALCON-C' is connected: there are 'FALCON-A', 'FALCON-B'"));
}

TEST_CASE("an OpenFFBoard is taken off the kernel's driver to be used, not to be listed, and given back")
{
    FakeBoard board;
    UsbBus bus;
    bus.plug(board, 4, "1234", "usbhid");
    const UsbList list = list_openffboards();
    REQUIRE(list.devices.size() == 1);
    CHECK(list.devices[0].serial == "1234");
    CHECK(list.devices[0].refused.empty());
    CHECK(bus.kernel_has(4));
    {
        const DeviceResult opened = open_openffboard("1234", request_for("openffboard:1234"));
        REQUIRE(opened.error == "");
        CHECK(opened.device->info().axes.senses.y);
        CHECK(ticks_until(*opened.device, DeviceStatus::ok)); // it was nudged
        CHECK(!bus.kernel_has(4));
    }
    CHECK(bus.kernel_has(4));
    CHECK(board.mistakes().empty());
}

TEST_CASE("a device that this user may not open is listed with what to do about it")
{
    FakeFalcon falcon(true);
    UsbBus bus;
    bus.plug(falcon, 2, "FALCON-A");
    bus.forbid(2);
    const WithoutPrivilege nobody;
    const UsbList list = list_falcons();
    REQUIRE(list.devices.size() == 1);
    CHECK(contains(list.devices[0].refused.text(), "0403:cb48 (bus 1, device 2): no permission to open it"));
    CHECK(contains(list.devices[0].refused.text(), "60-haptel.rules"));
    const OpenedTransport opened = open_usb(falcon_ids, "", falcon_interface);
    CHECK(opened.code == UsbError::denied);
    CHECK(opened.error == list.devices[0].refused.text());
}

TEST_CASE("a device that another program holds is listed as in use, and is free when that ends")
{
    FakeFalcon falcon(true);
    UsbBus bus;
    bus.plug(falcon, 2, "FALCON-A");
    {
        const OpenedTransport holder = open_usb(falcon_ids, "", falcon_interface);
        REQUIRE(holder.error == "");
        const OpenedTransport second = open_usb(falcon_ids, "", falcon_interface);
        CHECK(second.code == UsbError::busy);
        CHECK(contains(second.error, "in use by another program"));
        const UsbList list = list_falcons();
        REQUIRE(list.devices.size() == 1);
        CHECK(list.devices[0].serial == "FALCON-A");
        CHECK(list.devices[0].refused.text() == second.error);
        CHECK(bus.is_held(2)); // by the one who had it before
    }
    CHECK(list_falcons().devices.at(0).refused.empty());
    CHECK(open_usb(falcon_ids, "", falcon_interface).error == "");
}

TEST_CASE("a device that is unplugged after it was listed is not connected; while it is open, it is gone")
{
    FakeFalcon falcon(true), other(true);
    UsbBus bus;
    bus.plug(falcon, 2, "FALCON-A");
    REQUIRE(list_falcons().devices.size() == 1);
    bus.unplug(2);
    CHECK(list_falcons().devices.empty());
    CHECK(open_usb(falcon_ids, "FALCON-A", falcon_interface).code == UsbError::not_found);

    bus.plug(other, 3, "FALCON-A");
    OpenedTransport opened = open_usb(falcon_ids, "FALCON-A", falcon_interface);
    REQUIRE(opened.error == "");
    bus.unplug(3);
    CHECK(opened.transport->control({0x40, 9, 1, 0}, {}, 1000).error == UsbError::gone);
}

TEST_CASE("a Falcon that is waited for is found when it comes, and again after it was unplugged")
{
    FakeFalcon falcon(true);
    UsbBus bus;
    FalconOptions options = quick_options();
    options.bring_up = {.probes = 3, .calls = 10, .reads = 50, .transfer_ms = 1000, .seconds = 20};
    FalconDevice device("falcon", [] { return open_usb(falcon_ids, "", falcon_interface); }, options);
    REQUIRE(ticks_until(device, DeviceStatus::not_ready, "no USB device 0403:cb48 is connected"));
    for (int address = 2; address < 5; ++address) {
        bus.plug(falcon, address, "FALCON-A");
        REQUIRE(ticks_until(device, DeviceStatus::ok));
        bus.unplug(address);
        REQUIRE(ticks_until(device, DeviceStatus::not_ready, "no USB device 0403:cb48 is connected"));
    }
    CHECK(falcon.violations() == 0);
}

TEST_CASE("open_falcon loads a Falcon that it finds on the USB, and one that is plugged in later in its place")
{
    const Folder folder;
    const std::vector<uint8_t> image = synthetic_firmware(20);
    const std::string file = folder.write("firmware.bin", {reinterpret_cast<const char*>(image.data()), image.size()});
    FakeFalcon first(false), second(false);
    UsbBus bus;
    bus.plug(first, 2, "FALCON-A");
    const DeviceResult opened = open_falcon(request_for("falcon"), "FALCON-A", file);
    REQUIRE(opened.error == "");
    REQUIRE(ticks_until(*opened.device, DeviceStatus::ok));
    CHECK(first.image() == image);
    bus.unplug(2);
    REQUIRE(ticks_until(*opened.device, DeviceStatus::not_ready, "no USB device 0403:cb48 with"));
    bus.plug(second, 3, "FALCON-A");
    REQUIRE(ticks_until(*opened.device, DeviceStatus::ok));
    CHECK(second.image() == image);
}
