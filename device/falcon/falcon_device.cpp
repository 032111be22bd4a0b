#include "device/falcon/falcon_device.h"

#include "runtime/geometry/finite.h"
#include "runtime/servo/real_time.h"

#include <utility>

namespace haptel::device {

namespace {

constexpr double falcon_stiffness_max_n_per_m = 2000;
constexpr double falcon_workspace_radius_m = 0.04, falcon_resolution_m = 0.04e-3;

} // namespace

glm::dvec3 falcon_world_m(const glm::dvec3& place_m) noexcept
{
    const glm::dvec3 p = place_m - falcon_centre_m;
    return {p.x, -p.z, p.y};
}

glm::dvec3 falcon_device_direction(const glm::dvec3& world) noexcept
{
    return {world.x, world.z, -world.y};
}

FalconDevice::FalconDevice(std::string name, OpenTransport open, FalconOptions options)
    : info_{std::move(name),    falcon_force_max_n, falcon_stiffness_max_n_per_m, falcon_workspace_radius_m, 0,
            falcon_resolution_m}
    , driver_(std::move(open), std::move(options))
{
}

// Zero force with it.
runtime::DeviceStatus FalconDevice::status_without_pose() noexcept
{
    has_pose_ = false;
    interrupted_ = true;
    switch (driver_.phase()) {
    case FalconPhase::disconnected: return runtime::DeviceStatus::disconnected;
    case FalconPhase::failed: return runtime::DeviceStatus::fault;
    case FalconPhase::connecting:
    case FalconPhase::streaming: return runtime::DeviceStatus::not_ready;
    }
    return runtime::DeviceStatus::fault;
}

// The place of the newest reply, if there is one that can be believed.
void FalconDevice::take_newest() noexcept
{
    FalconLink::Reading reading;
    if (!driver_.link().newest(reading)) {
        late_.fetch_add(filter_.has_place(), std::memory_order_relaxed);
        return;
    }
    if (reading.session != session_) return; // of a stream that is over
    buttons_.store(reading.reply.buttons, std::memory_order_relaxed);
    is_homed_.store(reading.reply.all_homed(), std::memory_order_relaxed);
    if (!reading.reply.all_homed()) {
        filter_.forget();
        return;
    }
    const glm::dvec3 angles_rad = falcon_encoder_angles(reading.reply.encoders);
    const auto found = falcon_place(angles_rad, filter_.place_m());
    if (!found) return;
    const Believed believed = filter_.add(found->place_m, reading.time_ns);
    if (believed == Believed::no) return;
    interrupted_ = interrupted_ || believed == Believed::after_a_jump;
    angles_rad_ = angles_rad;
    link_ns_ = reading.link_ns;
}

runtime::DeviceStatus FalconDevice::read(runtime::DevicePose& pose) noexcept
{
    const uint32_t session = driver_.link().session();
    if (session != std::exchange(session_, session)) filter_.forget();
    take_newest();
    const int64_t age_max_ns = int64_t{1'000'000} * driver_.options().pose_age_max_ms;
    const bool fresh = filter_.has_place() && runtime::monotonic_ns() - filter_.time_ns() <= age_max_ns;
    if (session == 0 || !fresh) return status_without_pose();

    has_pose_ = true;
    pose.tip_m = pose.tail_m = falcon_world_m(filter_.place_m());
    pose.periods = 0;
    pose.link_ns = std::exchange(link_ns_, 0);
    pose.interrupted = driver_.link().force_was_dropped() || interrupted_;
    interrupted_ = false;
    return runtime::DeviceStatus::ok;
}

runtime::DeviceStatus FalconDevice::write(const glm::dvec3& force_n, const glm::dvec3&) noexcept
{
    FalconCounts motors{};
    if (has_pose_ && runtime::finite(force_n)) {
        const double size_n = glm::length(force_n);
        const glm::dvec3 limited_n = size_n > info_.force_max_n ? force_n * (info_.force_max_n / size_n) : force_n;
        if (const auto torques = falcon_torques(falcon_device_direction(limited_n), filter_.place_m(), angles_rad_))
            motors = falcon_motor_counts(*torques);
    }
    driver_.link().command(motors);
    return has_pose_ ? runtime::DeviceStatus::ok : status_without_pose();
}

std::string FalconDevice::state() const
{
    if (driver_.phase() != FalconPhase::streaming || is_homed_.load(std::memory_order_relaxed)) return driver_.state();
    return "connected, but its arms do not know where they are: while its light is red, pull the grip out as far as it "
           "goes and push it in once";
}

void FalconDevice::stop() noexcept
{
    driver_.link().halt();
}

} // namespace haptel::device
