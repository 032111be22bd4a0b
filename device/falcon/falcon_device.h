// A Novint Falcon as the runtime sees it.
//
// World frame: x to the right, y away from the user, z up; the origin is the centre of the workspace, 125 mm before the
// plane of the arms' axles. The user pulls the grip out once and pushes it in, so that the arms are homed; until then,
// and whenever no fresh reply is there, the device is not ready and its force is zero.
#pragma once

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_kinematics.h"
#include "device/falcon/falcon_place_filter.h"
#include "runtime/hand/haptic_device.h"

#include <string>

namespace haptel::device {

inline constexpr double falcon_force_max_n = 7;

// Of the grip, from where the device says it is; directions are turned alike.
glm::dvec3 falcon_world_m(const glm::dvec3& place_m) noexcept;
glm::dvec3 falcon_device_direction(const glm::dvec3& world) noexcept;

// Reads and writes on the servo's thread only compute and hand over: what may wait is done on the driver's.
class FalconDevice final : public runtime::HapticDevice {
public:
    FalconDevice(std::string name, OpenTransport open, FalconOptions options);

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override;
    // At most 7 N, direction kept. Zero unless the last read gave a pose; the torque has no effect.
    runtime::DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override;
    void stop() noexcept override; // for good

    std::string state() const override; // connected, or why not

    // Any thread but the servo's.
    FalconCounters counters() const { return driver_.link().counters(); }
    uint64_t late() const { return late_.load(std::memory_order_relaxed); } // reads that found no reply since the last
    uint8_t buttons() const { return buttons_.load(std::memory_order_relaxed); }

private:
    runtime::DeviceStatus status_without_pose() noexcept;
    void take_newest() noexcept;

    runtime::DeviceInfo info_;
    // The servo's thread alone.
    FalconPlaceFilter filter_;
    glm::dvec3 angles_rad_{0}; // at the place that was believed last
    int64_t link_ns_ = 0;      // of the same, until it was told
    uint32_t session_ = 0;
    bool has_pose_ = false;   // the last read gave one
    bool interrupted_ = true; // told of with the next pose
    std::atomic<uint64_t> late_{0};
    std::atomic<uint8_t> buttons_{0};
    std::atomic<bool> is_homed_{true}; // as far as it is known
    FalconDriver driver_;              // last: its thread ends first
};

} // namespace haptel::device
