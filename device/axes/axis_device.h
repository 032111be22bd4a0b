// A wheel or a stick with force feedback as the runtime sees it: one axis (x) or two (x to the right, y away from the
// user), the origin in the middle of its travel. FewerAxes imagines the rest.
#pragma once

#include "device/axes/axis_driver.h"
#include "device/axes/axis_settings.h"
#include "runtime/hand/haptic_device.h"

#include <string>

namespace haptel::device {

class AxisDevice final : public runtime::HapticDevice {
public:
    AxisDevice(std::string name, OpenAxes open, const AxisSettings& settings, const AxisTimes& times);

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
    AxisReading reading_;
    uint32_t session_ = 0;
    bool has_pose_ = false, interrupted_ = true;
    AxisDriver driver_; // last: its thread ends first
};

// Tries to open it here, so that what is wrong is told of at once; the driver opens it anew. The device is not ready
// until it was nudged.
runtime::DeviceResult open_axes(const runtime::DeviceRequest& request, OpenAxes open, AxisSettings settings);

} // namespace haptel::device
