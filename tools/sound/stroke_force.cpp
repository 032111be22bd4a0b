#include "tools/sound/stroke_force.h"

#include "runtime/servo/real_time.h"

#include <algorithm>
#include <utility>

namespace haptel::tools::sound {

namespace {

runtime::HandSettings with_limit_of(const runtime::HapticDevice& device, runtime::HandSettings settings)
{
    settings.force_max_n = device.info().force_max_n;
    return settings;
}

} // namespace

StrokeForce::StrokeForce(std::shared_ptr<const runtime::Scene> scene, runtime::LoadedHand hand)
    : device_(std::move(hand.device)), renderer_(std::move(scene), with_limit_of(*device_, hand.settings))
{
    runtime::set_exact_floating_point();
    error_ = renderer_.refused();
}

bool StrokeForce::next(Stroked& stroked)
{
    if (!error_.empty()) return false;
    runtime::DevicePose pose;
    const runtime::DeviceStatus status = device_->read(pose);
    if (status != runtime::DeviceStatus::ok) {
        if (status != runtime::DeviceStatus::finished) error_ = "the device of the scene has no pose";
        return false;
    }
    const runtime::TickResult tick = renderer_.tick(pose);
    device_->write_grip(tick.grip_force_n);
    device_->write(tick.force_n, tick.torque_n_m);
    renderer_.between_ticks();
    stroked.force_n = tick.force_n;
    stroked.normal = tick.normal;
    const double rate_hz = renderer_.rate_hz() / static_cast<double>(std::max<uint64_t>(pose.periods, 1));
    stroked.velocity_m_per_s = started_ ? (pose.tip_m - last_tip_m_) * rate_hz : glm::dvec3(0);
    started_ = true;
    last_tip_m_ = pose.tip_m;
    contact_ticks_ += tick.contacts > 0;
    faults_ += tick.faults != 0;
    return true;
}

} // namespace haptel::tools::sound
