// A real servo with a real driver over the real libusb, whose thread stands still in the middle of a stroke: how long
// its force stays on the motors.
#include "device/falcon/falcon_device.h"
#include "device/servo_silence.h"
#include "device/usb/usb_transport.h"
#include "runtime/servo/servo_thread.h"
#include "runtime/surface/shapes.h"
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/falcon/falcon_truth.h"
#include "tests/device/falcon/quick_falcon.h"
#include "tests/device/usb/usbfs_shim.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>
#include <pthread.h>
#include <time.h>
#include <vector>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

using StuckClock = std::chrono::steady_clock;

std::atomic<pthread_t> servo_thread{};
std::atomic<bool> has_pose{false};
constexpr long stuck_ms = 60;

// As a debugger stops a thread: within whatever it does.
extern "C" void stand_still(int)
{
    const timespec time{0, stuck_ms * 1'000'000};
    nanosleep(&time, nullptr);
}

// What a servo has, and which thread it is.
class KnownThread final : public HapticDevice {
public:
    explicit KnownThread(FalconDevice& device) : device_(device) {}
    const DeviceInfo& info() const override { return device_.info(); }
    DeviceStatus read(DevicePose& pose) noexcept override
    {
        servo_thread = pthread_self();
        const DeviceStatus status = device_.read(pose);
        has_pose = status == DeviceStatus::ok;
        return status;
    }
    DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override
    {
        return device_.write(force_n, torque_n_m);
    }
    void stop() noexcept override { device_.stop(); }

private:
    FalconDevice& device_;
};

std::shared_ptr<const Scene> plane_under_the_hand()
{
    auto scene = std::make_shared<Scene>();
    Mesh mesh = make_plane(4);
    scale_to_size(mesh, 0.2);
    SceneObject plane;
    plane.name = "plane";
    plane.surface = build_surface(mesh).surface;
    plane.texture = std::make_shared<TextureSlot>(haptel::TextureBinding{});
    scene->objects.push_back(std::move(plane));
    return scene;
}

} // namespace

TEST_CASE("a servo that stands still has its force taken away, and begins again from none")
{
    FakeFalcon falcon(true);
    UsbfsShim shim(falcon);
    FalconOptions options = quick_options();
    options.times.watchdog_ms = servo_silence_ms(1000);
    FalconDevice device("falcon", [fd = shim.file_descriptor()] { return open_usb(fd, UsbInterface{}); }, options);
    falcon.set_encoders(encoders_at({0, 0.002, 0.125})); // 2 mm above the plane
    ServoThread servo(plane_under_the_hand(), std::make_unique<KnownThread>(device), ServoOptions{});
    const auto old = std::signal(SIGUSR2, stand_still);
    servo.start();

    const auto pushes = [&] { return falcon.motors() != FakeFalcon::Motors{}; };
    const auto comes = [](auto happens) {
        const auto deadline = StuckClock::now() + std::chrono::seconds(20);
        while (!happens() && StuckClock::now() < deadline) std::this_thread::sleep_for(std::chrono::microseconds(50));
        return happens();
    };
    REQUIRE(comes([&] { return has_pose.load(); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    falcon.set_encoders(encoders_at({0, -0.002, 0.125}));
    std::vector<double> took_ms;
    for (int i = 0; i < 20; ++i) {
        REQUIRE(comes(pushes));
        pthread_kill(servo_thread, SIGUSR2);
        const auto start = StuckClock::now();
        REQUIRE(comes([&] { return !pushes(); }));
        took_ms.push_back(std::chrono::duration<double, std::milli>(StuckClock::now() - start).count());
    }
    std::sort(took_ms.begin(), took_ms.end());
    WARN("the motors had no force after " << took_ms[took_ms.size() / 2] << " ms in the median, the longest "
                                          << took_ms.back());
    CHECK(took_ms.front() < stuck_ms); // by somebody else than the servo
    CHECK(device.counters().dropped >= 20);
    servo.request_stop();
    const ServoReport& report = servo.wait();
    CHECK(report.missed_deadlines > 20 * (stuck_ms - 10));
    CHECK(report.link_ns.count() > 0);
    CHECK(falcon.violations() == 0);
    std::signal(SIGUSR2, old);
}
