// Options for a Falcon in tests: short waits where a fake answers at once, long ones where this machine may be late.
#pragma once

#include "device/falcon/falcon_device.h"
#include "tests/device/falcon/firmware_image.h"

#include <chrono>
#include <thread>

namespace haptel::device {

inline FalconOptions quick_options()
{
    FalconOptions options;
    options.firmware = synthetic_firmware(50);
    options.bring_up = {.probes = 2, .calls = 10, .reads = 25, .transfer_ms = 10, .seconds = 5};
    options.again_ms = 2;
    options.pose_age_max_ms = 200; // this machine may be busy
    options.times.watchdog_ms = 400;
    options.times.silence_ms = 600;
    options.real_time = false;
    return options;
}

// Ticks until `until(status)`, at most for some seconds. True if it came to that.
template <typename Until>
bool tick_until(FalconDevice& device, const glm::dvec3& force_n, Until until)
{
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < deadline) {
        runtime::DevicePose pose;
        const runtime::DeviceStatus status = device.read(pose);
        device.write(force_n, glm::dvec3(0));
        if (until(status)) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

} // namespace haptel::device
