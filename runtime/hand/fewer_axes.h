// A device that senses or pushes fewer than three axes, made whole: what it lacks is held by an imagined finger.
//
// - An axis along the surface (x, y) that is not sensed stays where the workspace's origin is: a device of one axis
//   feels the line along the workspace's x.
// - Without the axis z the finger lies on the surface below, pressed in by `press_depth_m` along its normal. Where the
//   surface steps by more than a hand can follow, and where there was none, it is lifted and laid down anew.
// - A force along an axis that is not pushed is not felt. What is left of a texture are its slopes along the others:
//   the lateral force (Minsky 1995), from which a hand tells shape as well (Robles-De-La-Torre and Hayward 2001).
#pragma once

#include "runtime/hand/haptic_device.h"

#include <memory>

namespace haptel::runtime {

class FewerAxes final : public HapticDevice {
public:
    // Of the device's space, in which the surface is told. `press_depth_m`: of the finger, below the surface.
    FewerAxes(std::unique_ptr<HapticDevice> device, SurfaceBelow surface_below, double press_depth_m, double rate_hz);

    // The device's, with all axes.
    const DeviceInfo& info() const override { return info_; }
    DeviceStatus read(DevicePose& pose) noexcept override;
    DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override;
    void write_grip(double grip_force_n) noexcept override { device_->write_grip(grip_force_n); }
    std::string state() const override { return device_->state(); }
    void stop() noexcept override { device_->stop(); }

private:
    glm::dvec3 laid_on_surface(const glm::dvec3& hand_m, uint64_t periods) noexcept;

    std::unique_ptr<HapticDevice> device_;
    DeviceAxes axes_;
    DeviceInfo info_;
    SurfaceBelow surface_below_;
    double press_depth_m_;
    double lowered_per_period_m_;
    double above_m_; // of the finger, above where it presses
    std::optional<SurfaceHit> last_;
    glm::dvec3 last_hand_m_{0};
};

} // namespace haptel::runtime
