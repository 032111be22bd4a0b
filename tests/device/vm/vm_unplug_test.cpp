// What the real-time thread of a driver does while the kernel takes its device away.
#include "device/falcon/falcon_link.h"
#include "device/falcon/open_falcon.h"
#include "device/usb/usb_transport.h"
#include "runtime/servo/real_time.h"
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/usb/usbip_port.h"
#include "tests/device/vm/comes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <ctime>
#include <optional>
#include <pthread.h>
#include <thread>

using namespace haptel::device;

namespace {

double seconds_of(clockid_t clock)
{
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace

// The kernel says that the device is gone some time before it gives back what is in flight. A thread of a servo's
// priority that polls in between without rest keeps the kernel from going on, on the processor that both are on. It
// happens in one of some unpluggings; then it takes a quarter of a second or more.
TEST_CASE("a stream does not keep the processor from the kernel that takes its device away")
{
    FakeFalcon falcon(true);
    double busiest_s = 0;
    for (int i = 0; i < 25; ++i) {
        std::optional<UsbipPort> port(std::in_place, falcon, "A42");
        OpenedTransport opened = open_usb(falcon_ids, "A42", {0, EndpointKind::bulk});
        REQUIRE(opened.error == "");
        FalconLink link({});
        link.begin_session();
        UsbError ended = UsbError::none;
        double busy_until_s = 0;
        std::thread driver([&] {
            haptel::runtime::ask_for_real_time();
            ended = opened.transport->stream({}, link.wake_event(), link);
            busy_until_s = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        });
        const uint64_t transfers = falcon.operations();
        CHECK(comes([&] { return falcon.operations() > transfers + 20; }));
        clockid_t clock_of_driver{};
        pthread_getcpuclockid(driver.native_handle(), &clock_of_driver);
        const double busy_before_s = seconds_of(clock_of_driver);
        port.reset();
        driver.join();
        CHECK(ended == UsbError::gone);
        busiest_s = std::max(busiest_s, busy_until_s - busy_before_s);
    }
    WARN("unplugged 25 times: the driver's thread was busy with it for at most " << busiest_s << " s");
    CHECK(busiest_s < 0.1);
}
