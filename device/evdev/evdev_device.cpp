#include "device/evdev/evdev_device.h"

#include "runtime/geometry/finite.h"

#include <utility>

namespace haptel::device {

namespace {

runtime::DeviceInfo info_of(std::string name, const EvdevSettings& settings)
{
    const bool two = settings.axes > 1;
    runtime::DeviceInfo info;
    info.name = std::move(name);
    info.force_max_n = settings.force_max_n;
    info.workspace_radius_m = settings.travel_m / 2;
    info.axes = {{true, two, false}, {true, two, false}};
    return info;
}

} // namespace

EvdevDevice::EvdevDevice(std::string name, OpenInput open, const EvdevSettings& settings, const EvdevTimes& times)
    : info_(info_of(std::move(name), settings)), travel_m_(settings.travel_m), driver_(std::move(open), times)
{
}

runtime::DeviceStatus EvdevDevice::status_without_pose() noexcept
{
    has_pose_ = false;
    interrupted_ = true;
    switch (driver_.phase()) {
    case EvdevPhase::disconnected: return runtime::DeviceStatus::disconnected;
    case EvdevPhase::failed: return runtime::DeviceStatus::fault;
    case EvdevPhase::connecting:
    case EvdevPhase::nudging:
    case EvdevPhase::running: return runtime::DeviceStatus::not_ready;
    }
    return runtime::DeviceStatus::fault;
}

runtime::DeviceStatus EvdevDevice::read(runtime::DevicePose& pose) noexcept
{
    driver_.newest(reading_);
    if (driver_.phase() != EvdevPhase::running || reading_.session == 0) return status_without_pose();
    interrupted_ = interrupted_ || std::exchange(session_, reading_.session) != reading_.session;
    has_pose_ = true;
    // A stick's y grows towards the user.
    pose.tip_m = travel_m_ * glm::dvec3(reading_.place[0], -reading_.place[1], 0);
    pose.tail_m = pose.tip_m;
    pose.periods = 0;
    pose.interrupted = driver_.force_was_dropped() || interrupted_;
    interrupted_ = false;
    return runtime::DeviceStatus::ok;
}

runtime::DeviceStatus EvdevDevice::write(const glm::dvec3& force_n, const glm::dvec3&) noexcept
{
    glm::dvec3 share(0);
    if (has_pose_ && runtime::finite(force_n)) {
        share = glm::mix(glm::dvec3(0), force_n, info_.axes.pushes) / info_.force_max_n;
        if (const double size = glm::length(share); size > 1) share /= size;
    }
    driver_.command({share.x, -share.y});
    return has_pose_ ? runtime::DeviceStatus::ok : status_without_pose();
}

} // namespace haptel::device
