// A device and the hand that holds it, as a mass with damping and dry friction: the default device of every scene.
//
// Along the axes that the device senses:
//
//   M dv/dt = u - b v - c v/|v| + k (aim - x) + b_hand (aim' - v) + push,    M = device + hand
//
// A gripper's first finger is such a mass, and what it is open is another one, of the same figures. The hand does not
// push then: it closes the fingers where it would press, lets them carry the arm up or down, and holds them open
// elsewhere.
//
// u is the force written, held over each period and acting one period late, as on a real bus; the position is read
// through an encoder. Every read() after the first advances by exactly one nominal period, whatever the wall clock
// says, so that equal scenes give equal bits.
#pragma once

#include "device/hand.h"
#include "device/presets.h"

#include <vector>

namespace haptel::device {

class SimulatedDevice final : public runtime::HapticDevice {
public:
    struct Options {
        double rate_hz = 1000;
        double stylus_length_m = 0; // 0: point probe, no tail; of a gripper: how far it opens
        bool gripper = false;       // its second finger is below the first
        int delay_periods = 1;      // 0: a force acts in the period after it was written; 1: in the next ...
        int hold_periods = 1;       // how often one is taken
    };

    SimulatedDevice(runtime::DeviceInfo info, const DeviceModel& model, Hand hand, const Options& options);

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override;
    // Saturates at force_max_n, direction kept; a force that is not finite is none. The torque has no effect.
    runtime::DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override;
    void write_grip(double grip_force_n) noexcept override;
    void stop() noexcept override;

    // The truth behind the encoder, for tests and energy balances.
    glm::dvec3 position_m() const { return tip_.position_m; }
    glm::dvec3 velocity_m_per_s() const { return tip_.velocity_m_per_s; }
    void set_velocity(const glm::dvec3& velocity_m_per_s) { tip_.velocity_m_per_s = velocity_m_per_s; }

private:
    struct Mass {
        glm::dvec3 position_m{0}, velocity_m_per_s{0};
    };

    struct Sent {
        glm::dvec3 force_n{0};
        double grip_n = 0;
    };

    void advance_period() noexcept;
    void step(Mass& mass, const glm::dvec3& force_n) const noexcept; // one substep

    runtime::DeviceInfo info_;
    DeviceModel model_;
    Hand hand_;
    double period_s_;
    int substeps_; // of at most 10 us
    int hold_periods_, held_periods_ = 0;
    bool gripper_;
    glm::dvec3 free_;   // 1 along each axis that it senses, else 0
    glm::dvec3 open_m_; // of a stylus and of an open gripper: its tail from its tip
    Mass tip_, opening_;
    std::vector<Sent> on_the_way_; // the first is the next to act, the last was written last
    double grip_written_n_ = 0;    // for the next force
    Sent acting_;
    bool started_ = false;
};

} // namespace haptel::device
