// Times for tests against a fake service: short waits where it answers at once, long ones where this machine may be
// late.
#pragma once

#include "device/inverse3/inverse3_device.h"
#include "tests/device/inverse3/fake_service.h"

#include <chrono>
#include <thread>

namespace haptel::device {

inline Inverse3Times quick_times()
{
    Inverse3Times times;
    times.connect_ms = 3000; // this machine may be busy
    times.silence_ms = 1500;
    times.watchdog_ms = 400;
    times.close_ms = 1000;
    times.pose_age_max_ms = 400;
    times.again_ms = 2;
    times.real_time = false;
    times.guarded = false; // on a busy machine a guard says more than the driver, and is answered
    return times;
}

inline ServiceAddress address_of(const FakeService& service)
{
    return {"127.0.0.1", service.port()};
}

// Ticks until `until(status, pose)`, at most for some seconds. True if it came to that.
template <typename Until>
bool tick_until(Inverse3Device& device, const glm::dvec3& force_n, Until until)
{
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
    while (std::chrono::steady_clock::now() < deadline) {
        runtime::DevicePose pose;
        const runtime::DeviceStatus status = device.read(pose);
        device.write(force_n, glm::dvec3(0));
        if (until(status, pose)) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

inline bool tick_until(Inverse3Device& device, const glm::dvec3& force_n, runtime::DeviceStatus wanted)
{
    return tick_until(device, force_n, [&](runtime::DeviceStatus status, const auto&) { return status == wanted; });
}

} // namespace haptel::device
