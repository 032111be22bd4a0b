#include "device/inverse3/inverse3_device.h"

#include "runtime/geometry/finite.h"
#include "runtime/servo/real_time.h"

#include <utility>

namespace haptel::device {

namespace {

constexpr double inverse3_stiffness_max_n_per_m = 1000, inverse3_workspace_radius_m = 0.15;

} // namespace

Inverse3Device::Inverse3Device(std::string name, ServiceAddress address, std::string id, const Inverse3Times& times)
    : driver_(std::move(address), std::move(id), times)
{
    info_.name = std::move(name);
    info_.force_max_n = inverse3_force_max_n;
    info_.stiffness_max_n_per_m = inverse3_stiffness_max_n_per_m;
    info_.workspace_radius_m = inverse3_workspace_radius_m;
}

// Zero force with it.
runtime::DeviceStatus Inverse3Device::status_without_pose() noexcept
{
    has_pose_ = false;
    interrupted_ = true;
    switch (driver_.phase()) {
    case Inverse3Phase::disconnected: return runtime::DeviceStatus::disconnected;
    case Inverse3Phase::failed: return runtime::DeviceStatus::fault;
    case Inverse3Phase::connecting:
    case Inverse3Phase::streaming: return runtime::DeviceStatus::not_ready;
    }
    return runtime::DeviceStatus::fault;
}

runtime::DeviceStatus Inverse3Device::read(runtime::DevicePose& pose) noexcept
{
    const uint32_t session = driver_.session();
    const bool is_new = driver_.newest(reading_);
    const int64_t age_max_ns = int64_t{1'000'000} * driver_.times().pose_age_max_ms;
    const bool is_fresh = runtime::monotonic_ns() - reading_.time_ns <= age_max_ns;
    if (session == 0 || reading_.session != session || !is_fresh) return status_without_pose();

    interrupted_ = interrupted_ || std::exchange(session_, session) != session;
    has_pose_ = true;
    pose.tip_m = reading_.state.position_m - (reading_.is_centred ? glm::dvec3(0) : inverse3_centre_m);
    pose.tail_m = pose.tip_m;
    pose.periods = 0;
    pose.link_ns = is_new ? reading_.link_ns : 0;
    pose.interrupted = driver_.force_was_dropped() || interrupted_;
    interrupted_ = false;
    return runtime::DeviceStatus::ok;
}

runtime::DeviceStatus Inverse3Device::write(const glm::dvec3& force_n, const glm::dvec3&) noexcept
{
    glm::dvec3 limited_n(0);
    if (has_pose_ && runtime::finite(force_n)) {
        const double size_n = glm::length(force_n);
        limited_n = size_n > info_.force_max_n ? force_n * (info_.force_max_n / size_n) : force_n;
    }
    driver_.command(limited_n, session_);
    return has_pose_ ? runtime::DeviceStatus::ok : status_without_pose();
}

} // namespace haptel::device
