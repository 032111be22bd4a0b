#include "device/simulated_device.h"

#include "runtime/geometry/finite.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::device {

namespace {

constexpr double substep_max_s = 10e-6;

// A right hand at -y holds its stylus leaning towards itself.
const glm::dvec3 stylus_direction = glm::normalize(glm::dvec3(0, -0.25, 1));
// With its thumb below what it holds.
const glm::dvec3 gripper_direction(0, 0, -1);

glm::dvec3 quantized(const glm::dvec3& position_m, double step_m)
{
    return step_m > 0 ? step_m * glm::round(position_m / step_m) : position_m;
}

} // namespace

SimulatedDevice::SimulatedDevice(runtime::DeviceInfo info, const DeviceModel& model, Hand hand, const Options& options)
    : info_(std::move(info))
    , model_(model)
    , hand_(std::move(hand))
    , period_s_(1 / options.rate_hz)
    , substeps_(std::max(1, static_cast<int>(std::ceil(period_s_ / substep_max_s - 1e-6))))
    , hold_periods_(options.hold_periods)
    , gripper_(options.gripper)
    , free_(glm::mix(glm::dvec3(0), glm::dvec3(1), model.axes.senses))
    , open_m_(options.stylus_length_m * (gripper_ ? gripper_direction : stylus_direction))
    , tip_{free_ * hand_.aim_m(1)}
    , opening_{open_m_}
    , on_the_way_(static_cast<std::size_t>(options.delay_periods) + 1)
{
}

runtime::DeviceStatus SimulatedDevice::read(runtime::DevicePose& pose) noexcept
{
    if (std::exchange(started_, true)) advance_period();
    pose.tip_m = quantized(tip_.position_m, model_.encoder_m);
    pose.tail_m = pose.tip_m + (gripper_ ? quantized(opening_.position_m, model_.encoder_m) : open_m_);
    pose.periods = 1;
    return runtime::DeviceStatus::ok;
}

runtime::DeviceStatus SimulatedDevice::write(const glm::dvec3& force_n, const glm::dvec3&) noexcept
{
    Sent sent{runtime::finite(force_n) ? glm::mix(glm::dvec3(0), force_n, model_.axes.pushes) : glm::dvec3(0),
              grip_written_n_};
    if (const double size_n = glm::length(sent.force_n); size_n > model_.force_max_n)
        sent.force_n *= model_.force_max_n / size_n;
    std::shift_left(on_the_way_.begin(), on_the_way_.end(), 1);
    on_the_way_.back() = sent;
    if (held_periods_++ % hold_periods_ == 0) acting_ = on_the_way_.front();
    return runtime::DeviceStatus::ok;
}

void SimulatedDevice::write_grip(double grip_force_n) noexcept
{
    grip_written_n_ =
        std::isfinite(grip_force_n) ? std::clamp(grip_force_n, -model_.force_max_n, model_.force_max_n) : 0;
}

void SimulatedDevice::stop() noexcept
{
    std::ranges::fill(on_the_way_, Sent());
    acting_ = {};
    grip_written_n_ = 0;
}

// Damping and friction are implicit, which makes sticking exact: the mass stands still when, and only when, friction
// can hold it. The spring is symplectic, which keeps its energy.
void SimulatedDevice::step(Mass& mass, const glm::dvec3& force_n) const noexcept
{
    const HandImpedance& hand = hand_.impedance();
    const double dt = period_s_ / substeps_;
    const double dt_by_mass = dt / (model_.mass_kg + hand.mass_kg);
    const double damping = 1 + dt_by_mass * (model_.damping_n_s_per_m + hand.damping_n_s_per_m);
    const double stopped_by_friction = dt_by_mass * model_.coulomb_n; // speed lost in a substep

    const glm::dvec3 driven = mass.velocity_m_per_s + dt_by_mass * force_n;
    const double speed = glm::length(driven);
    mass.velocity_m_per_s =
        speed <= stopped_by_friction ? glm::dvec3(0) : driven * ((1 - stopped_by_friction / speed) / damping);
    mass.position_m += dt * mass.velocity_m_per_s;
}

void SimulatedDevice::advance_period() noexcept
{
    hand_.advance();
    const HandImpedance& hand = hand_.impedance();
    const glm::dvec3 towards_aim_n = hand.damping_n_s_per_m * hand_.aim_velocity_m_per_s();
    for (int i = 1; i <= substeps_; ++i) {
        const double share = static_cast<double>(i) / substeps_;
        const double opened = hand_.opened(share);
        const glm::dvec3 push_n = gripper_ ? glm::dvec3(0) : hand_.push_n(share);
        const glm::dvec3 held(1, 1, gripper_ ? opened : 1); // the arm goes where the fingers find their balance
        step(tip_, free_ * (acting_.force_n + push_n + towards_aim_n +
                            hand.stiffness_n_per_m * (held * (hand_.aim_m(share) - tip_.position_m))));
        if (!gripper_) continue;
        step(opening_, (acting_.grip_n - hand_.squeeze_n(share)) * gripper_direction +
                           opened * hand.stiffness_n_per_m * (open_m_ - opening_.position_m));
        if (glm::dot(opening_.position_m, gripper_direction) < 0) opening_ = {}; // the fingers meet
    }
}

} // namespace haptel::device
