// The Falcon's driver over the real libusb and the real kernel.
#include "device/falcon/falcon_device.h"
#include "device/falcon/open_falcon.h"
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/falcon/falcon_exchange.h"
#include "tests/device/falcon/quick_falcon.h"
#include "tests/device/usb/usbip_port.h"
#include "tests/device/vm/as_nobody.h"
#include "tests/device/vm/open_by_name.h"
#include "tests/support/catch.h"

#include <filesystem>
#include <fstream>
#include <optional>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

// A file of firmware where `--device falcon` looks for it.
class FirmwareFileOfUser {
public:
    FirmwareFileOfUser()
    {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
        setenv("HAPTEL_FALCON_FIRMWARE", path_.c_str(), 1);
    }
    ~FirmwareFileOfUser()
    {
        unsetenv("HAPTEL_FALCON_FIRMWARE");
        std::filesystem::remove(path_);
    }
    FirmwareFileOfUser(const FirmwareFileOfUser&) = delete;
    FirmwareFileOfUser& operator=(const FirmwareFileOfUser&) = delete;

    const std::vector<uint8_t> image = synthetic_firmware();

private:
    std::filesystem::path path_ = std::filesystem::temp_directory_path() / "haptel_vm_test_firmware.bin";
};

struct OpenedFalcon {
    std::unique_ptr<HapticDevice> device;
    FalconDevice& falcon;

    explicit OpenedFalcon(const std::string& name)
        : device(open_by_name(name)), falcon(dynamic_cast<FalconDevice&>(*device))
    {
    }
};

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool becomes_ready(FalconDevice& falcon)
{
    return tick_until(falcon, glm::dvec3(0), [](DeviceStatus status) { return status == DeviceStatus::ok; });
}

} // namespace

TEST_CASE("a Falcon is listed by its ids and its serial number while it is plugged in")
{
    FakeFalcon falcon(true);
    CHECK(list_falcons().devices.empty());
    {
        UsbipPort port(falcon, "A42");
        const UsbList list = list_falcons();
        CHECK(list.error == "");
        REQUIRE(list.devices.size() == 1);
        CHECK(list.devices[0].serial == "A42");
        CHECK(list.devices[0].refused.empty());
    }
    CHECK(list_falcons().devices.empty());
    CHECK(why_not_opened("falcon").find("no USB device 0403:cb48 is connected") != std::string::npos);
}

TEST_CASE("two Falcons are told apart by their serial numbers")
{
    const FirmwareFileOfUser firmware;
    FakeFalcon first(false), second(false);
    UsbipPort first_port(first, "A42"), second_port(second, "B43");
    CHECK(list_falcons().devices.size() == 2);
    OpenedFalcon opened("falcon:B43");
    REQUIRE(becomes_ready(opened.falcon));
    CHECK(second.image() == firmware.image);
    CHECK(first.operations() == 0);
    CHECK(why_not_opened("falcon:B43").find("in use by another program") != std::string::npos);
    CHECK(why_not_opened("falcon:C44").find("serial number 'C44'") != std::string::npos);
}

TEST_CASE("a Falcon on the kernel's USB is loaded, homed and exchanges packets at 1 kHz, with the forces as commanded")
{
    const FirmwareFileOfUser firmware;
    FakeFalcon fake(false, 50);
    UsbipPort port(fake, "A42");
    const auto start = std::chrono::steady_clock::now();
    OpenedFalcon opened("falcon:A42");
    REQUIRE(becomes_ready(opened.falcon));
    const double ready_s = seconds_since(start);
    CHECK(fake.image() == firmware.image);
    const Exchange done = exchange(opened.falcon, fake, exchange_seconds());
    WARN("Falcon: ready after " << ready_s << " s; " << in_words(done));
    CHECK(done.poses >= 0.99 * done.ticks);
    CHECK(done.replies >= 0.99 * done.ticks); // the newest command replaces one that was not taken yet
    CHECK(done.replies >= 0.99 * done.sent);
    CHECK(done.worst_counts <= 1);
    CHECK(done.malformed == 0);
    CHECK(fake.violations() == 0);
    opened.device.reset();
    CHECK(fake.motors() == FakeFalcon::Motors{});
}

TEST_CASE("a Falcon that is unplugged from the kernel's USB is missed at once, and found when it is back")
{
    const FirmwareFileOfUser firmware;
    FakeFalcon fake(false);
    std::optional<UsbipPort> port(std::in_place, fake, "A42");
    OpenedFalcon opened("falcon:A42");
    REQUIRE(becomes_ready(opened.falcon));
    const glm::dvec3 force_n(0, 0, 1);
    auto start = std::chrono::steady_clock::now();
    port.reset();
    REQUIRE(tick_until(opened.falcon, force_n, [](DeviceStatus status) { return status == DeviceStatus::not_ready; }));
    const double noticed_s = seconds_since(start);
    CHECK(tick_until(opened.falcon, force_n, [&](DeviceStatus) {
        return opened.falcon.state().find("with the serial number 'A42' is connected") != std::string::npos;
    }));
    fake.plug_in();
    const uint64_t before = fake.packets_with_force();
    start = std::chrono::steady_clock::now();
    port.emplace(fake, "A42");
    DevicePose pose;
    for (int i = 0; i < 10'000 && opened.falcon.read(pose) != DeviceStatus::ok; ++i) {
        opened.falcon.write(force_n, glm::dvec3(0));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(pose.interrupted);
    CHECK(fake.packets_with_force() == before);
    CHECK(fake.violations() == 0);
    WARN("Falcon: unplugging and noticing took " << noticed_s << " s, coming back " << seconds_since(start) << " s");
    CHECK(noticed_s < 2);
}

TEST_CASE("a user who may not open a Falcon is told of the udev rule")
{
    FakeFalcon fake(true);
    UsbipPort port(fake, "A42");
    const std::string said = as_nobody([] { return why_not_opened("falcon"); });
    CAPTURE(said);
    CHECK(said.find("0403:cb48") != std::string::npos);
    CHECK(said.find("60-haptel.rules") != std::string::npos);
    const std::string listed = as_nobody([] {
        const UsbList list = list_falcons();
        return list.devices.empty() ? "not listed: " + list.error : list.devices[0].refused.text();
    });
    CHECK(listed == said.substr(std::string("falcon: ").size()));
}
