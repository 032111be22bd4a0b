// A Haply Inverse3 as the runtime sees it, through the service that its maker ships.
//
// World frame: x to the right, y away from the user, z up; the origin is the middle of the workspace.
#pragma once

#include "device/inverse3/inverse3_driver.h"
#include "runtime/hand/haptic_device.h"

#include <string>

namespace haptel::device {

inline constexpr double inverse3_force_max_n = 10;

// Of the middle of the workspace, where the service's origin is the device's base.
inline constexpr glm::dvec3 inverse3_centre_m{0, -0.15, 0.2};

// Reads and writes on the servo's thread only compute and hand over: what may wait is done on the driver's.
class Inverse3Device final : public runtime::HapticDevice {
public:
    Inverse3Device(std::string name, ServiceAddress address, std::string id, const Inverse3Times& times);

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override;
    // At most 10 N, direction kept. Zero unless the last read gave a pose; the torque has no effect.
    runtime::DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override;
    std::string state() const override { return driver_.state(); }
    void stop() noexcept override { driver_.halt(); } // for good

    Inverse3Counters counters() const noexcept { return driver_.counters(); } // any thread

private:
    runtime::DeviceStatus status_without_pose() noexcept;

    runtime::DeviceInfo info_;
    // The servo's thread alone.
    Inverse3Reading reading_;
    uint32_t session_ = 0;    // of the last pose
    bool has_pose_ = false;   // the last read gave one
    bool interrupted_ = true; // told of with the next pose
    Inverse3Driver driver_;   // last: its thread ends first
};

} // namespace haptel::device
