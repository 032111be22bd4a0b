#include "device/falcon/falcon_device.h"

#include "runtime/geometry/finite.h"
#include "runtime/servo/real_time.h"

#include <utility>

namespace haptel::device {

namespace {

constexpr double falcon_force_max_n = 7, falcon_stiffness_max_n_per_m = 2000;
constexpr double falcon_workspace_radius_m = 0.04, falcon_resolution_m = 0.04e-3;

// The serial line has no checksum: a flipped bit is a place far away. No hand moves as fast; a second reply from there
// is believed.
constexpr double jump_m = 0.003, hand_speed_limit_m_per_s = 5;

bool may_be_a_jump(const glm::dvec3& from_m, const glm::dvec3& to_m, int64_t elapsed_ns)
{
    return glm::distance(from_m, to_m) > jump_m + hand_speed_limit_m_per_s * 1e-9 * static_cast<double>(elapsed_ns);
}

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
        late_.fetch_add(has_place_, std::memory_order_relaxed);
        return;
    }
    if (reading.session != session_) return; // of a stream that is over
    buttons_.store(reading.reply.buttons, std::memory_order_relaxed);
    if (!reading.reply.all_homed()) {
        has_place_ = false;
        return;
    }
    const glm::dvec3 angles_rad = falcon_encoder_angles(reading.reply.encoders);
    const auto found = falcon_place(angles_rad, place_m_);
    if (!found) return;
    const int64_t elapsed_ns = reading.time_ns - place_ns_;
    if (has_place_ && may_be_a_jump(place_m_, found->place_m, elapsed_ns)) {
        const bool confirmed = is_doubtful_ && !may_be_a_jump(doubtful_m_, found->place_m, elapsed_ns);
        is_doubtful_ = true;
        doubtful_m_ = found->place_m;
        if (!confirmed) return;
        interrupted_ = true;
    }
    is_doubtful_ = false;
    place_m_ = found->place_m;
    angles_rad_ = angles_rad;
    place_ns_ = reading.time_ns;
    has_place_ = true;
}

runtime::DeviceStatus FalconDevice::read(runtime::DevicePose& pose) noexcept
{
    const uint32_t session = driver_.link().session();
    if (session != std::exchange(session_, session)) has_place_ = is_doubtful_ = false;
    take_newest();
    const int64_t age_max_ns = int64_t{1'000'000} * driver_.options().pose_age_max_ms;
    if (session == 0 || !has_place_ || runtime::monotonic_ns() - place_ns_ > age_max_ns) return status_without_pose();

    has_pose_ = true;
    pose.tip_m = pose.tail_m = falcon_world_m(place_m_);
    pose.periods = 0;
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
        if (const auto torques = falcon_torques(falcon_device_direction(limited_n), place_m_, angles_rad_))
            motors = falcon_motor_counts(*torques);
    }
    driver_.link().command(motors);
    return has_pose_ ? runtime::DeviceStatus::ok : status_without_pose();
}

void FalconDevice::stop() noexcept
{
    driver_.link().halt();
}

} // namespace haptel::device
