// A device and the hand that holds it, as a mass with damping and dry friction: the default device of every scene.
//
//   M dv/dt = u - b v - c v/|v| + k (aim - x) + b_hand (aim' - v) + push,    M = device + hand
//
// u is the force written, held over each period and acting one period late, as on a real bus; the position is read
// through an encoder. Every read() after the first advances by exactly one nominal period, whatever the wall clock
// says, so that equal scenes give equal bits.
#pragma once

#include "device/hand.h"
#include "device/presets.h"

namespace haptel::device {

class SimulatedDevice final : public runtime::HapticDevice {
public:
    struct Options {
        double rate_hz = 1000;
        double stylus_length_m = 0; // 0: point probe, no tail
        int delay_periods = 1;      // 0 or 1: whether a force acts in the period after it was written, or in the next
    };

    SimulatedDevice(runtime::DeviceInfo info, const DeviceModel& model, Hand hand, const Options& options);

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override;
    // Saturates at force_max_n, direction kept; a force that is not finite is none. The torque has no effect.
    runtime::DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override;
    void stop() noexcept override;

    // The truth behind the encoder, for tests and energy balances.
    glm::dvec3 position_m() const { return position_m_; }
    glm::dvec3 velocity_m_per_s() const { return velocity_m_per_s_; }
    void set_velocity(const glm::dvec3& velocity_m_per_s) { velocity_m_per_s_ = velocity_m_per_s; }

private:
    void advance_period() noexcept;

    runtime::DeviceInfo info_;
    DeviceModel model_;
    Hand hand_;
    double period_s_;
    int substeps_; // of at most 10 us
    int delay_periods_;
    glm::dvec3 tail_from_tip_m_;
    glm::dvec3 position_m_, velocity_m_per_s_{0};
    glm::dvec3 written_n_{0}, acting_n_{0};
    bool started_ = false;
};

} // namespace haptel::device
