#include "device/axes/axis_device.h"

#include "device/servo_silence.h"
#include "runtime/geometry/finite.h"

#include <utility>

namespace haptel::device {

namespace {

runtime::DeviceInfo info_of(std::string name, const AxisSettings& settings)
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

AxisDevice::AxisDevice(std::string name, OpenAxes open, const AxisSettings& settings, const AxisTimes& times)
    : info_(info_of(std::move(name), settings)), travel_m_(settings.travel_m), driver_(std::move(open), times)
{
}

runtime::DeviceStatus AxisDevice::status_without_pose() noexcept
{
    has_pose_ = false;
    interrupted_ = true;
    switch (driver_.phase()) {
    case AxisPhase::disconnected: return runtime::DeviceStatus::disconnected;
    case AxisPhase::failed: return runtime::DeviceStatus::fault;
    case AxisPhase::connecting:
    case AxisPhase::nudging:
    case AxisPhase::held:
    case AxisPhase::running: return runtime::DeviceStatus::not_ready;
    }
    return runtime::DeviceStatus::fault;
}

runtime::DeviceStatus AxisDevice::read(runtime::DevicePose& pose) noexcept
{
    driver_.newest(reading_);
    if (driver_.phase() != AxisPhase::running || reading_.session == 0) return status_without_pose();
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

runtime::DeviceStatus AxisDevice::write(const glm::dvec3& force_n, const glm::dvec3&) noexcept
{
    glm::dvec3 share(0);
    if (has_pose_ && runtime::finite(force_n)) {
        share = glm::mix(glm::dvec3(0), force_n, info_.axes.pushes) / info_.force_max_n;
        if (const double size = glm::length(share); size > 1) share /= size;
    }
    driver_.command({share.x, -share.y});
    return has_pose_ ? runtime::DeviceStatus::ok : status_without_pose();
}

runtime::DeviceResult open_axes(const runtime::DeviceRequest& request, OpenAxes open, AxisSettings settings)
{
    OpenedAxes tried = open();
    if (!tried.port) return {nullptr, std::move(tried.error)};
    settings.axes = axis_count(*tried.port);
    tried.port.reset();
    AxisTimes times;
    times.watchdog_ms = servo_silence_ms(request.rate_hz);
    return {std::make_unique<AxisDevice>(request.name, std::move(open), settings, times), {}};
}

} // namespace haptel::device
