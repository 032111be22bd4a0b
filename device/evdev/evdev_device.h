// A wheel or a stick with force feedback as the runtime sees it: one axis (x) or two (x to the right, y away from the
// user), the origin in the middle of its travel. FewerAxes imagines the rest.
#pragma once

#include "device/evdev/evdev_driver.h"
#include "runtime/hand/haptic_device.h"

#include <string>

namespace haptel::device {

struct EvdevSettings {
    double travel_m = 0.2;   // of the hand, from end to end of each axis
    double force_max_n = 10; // on the hand, at full level
    int axes = 1;
};

class EvdevDevice final : public runtime::HapticDevice {
public:
    EvdevDevice(std::string name, OpenInput open, const EvdevSettings& settings, const EvdevTimes& times);

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override;
    // Direction kept where it is more than the device can do. Zero unless the last read gave a pose.
    runtime::DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override;
    std::string state() const override { return driver_.state(); }
    void stop() noexcept override { driver_.halt(); } // for good

private:
    runtime::DeviceStatus status_without_pose() noexcept;

    runtime::DeviceInfo info_;
    double travel_m_;
    EvdevReading reading_;
    uint32_t session_ = 0;
    bool has_pose_ = false, interrupted_ = true;
    EvdevDriver driver_; // last: its thread ends first
};

} // namespace haptel::device
