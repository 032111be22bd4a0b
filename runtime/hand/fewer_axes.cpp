#include "runtime/hand/fewer_axes.h"

#include "runtime/geometry/finite.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

// A finger is put down from a millimetre above the surface, as fast as one that looks for it: 1 N on 1 N/mm comes
// within 25 ms.
constexpr double lifted_m = 1e-3;
constexpr double lowering_m_per_s = 0.04;

// Steeper than this (about 76 degrees) a surface is a step to a hand that is not held back by it.
constexpr double slope_max = 4;

} // namespace

FewerAxes::FewerAxes(std::unique_ptr<HapticDevice> device, SurfaceBelow surface_below, double press_depth_m,
                     double rate_hz)
    : device_(std::move(device))
    , axes_(device_->info().axes)
    , info_(device_->info())
    , surface_below_(std::move(surface_below))
    , press_depth_m_(press_depth_m)
    , lowered_per_period_m_(lowering_m_per_s / rate_hz)
    , above_m_(press_depth_m + lifted_m)
{
    info_.axes = {};
    info_.slopes_only = !axes_.senses.z || !axes_.pushes.z;
}

DeviceStatus FewerAxes::read(DevicePose& pose) noexcept
{
    const DeviceStatus status = device_->read(pose);
    if (status != DeviceStatus::ok) {
        above_m_ = press_depth_m_ + lifted_m; // nobody held it down meanwhile
        last_.reset();
        return status;
    }
    const glm::dvec3 tail_from_tip_m = pose.tail_m - pose.tip_m;
    for (int axis = 0; axis < 3; ++axis)
        if (!axes_.senses[axis]) pose.tip_m[axis] = 0;
    if (!axes_.senses.z) pose.tip_m = laid_on_surface(pose.tip_m, std::max(uint64_t{1}, pose.periods));
    pose.tail_m = pose.tip_m + tail_from_tip_m;
    return status;
}

glm::dvec3 FewerAxes::laid_on_surface(const glm::dvec3& hand_m, uint64_t periods) noexcept
{
    if (!finite(hand_m)) return hand_m; // the renderer says so
    const std::optional<SurfaceHit> hit = surface_below_(hand_m.x, hand_m.y);
    const double way_m = glm::length(glm::dvec2(hand_m - last_hand_m_));
    const bool follows = hit && last_ && std::abs(hit->point_m.z - last_->point_m.z) <= slope_max * way_m;
    above_m_ = follows ? std::max(0.0, above_m_ - lowered_per_period_m_ * static_cast<double>(periods))
                       : press_depth_m_ + lifted_m;
    last_hand_m_ = hand_m;
    const std::optional<SurfaceHit> before = std::exchange(last_, hit);
    // Beside everything it is held where it was last: nothing is there to touch.
    if (!hit && !before) return hand_m;
    const SurfaceHit& below = hit ? *hit : *before;
    if (!hit) last_ = before;
    const glm::dvec3 at_m = hit ? below.point_m : glm::dvec3(hand_m.x, hand_m.y, below.point_m.z);
    return at_m + (above_m_ - press_depth_m_) * below.facet_normal;
}

DeviceStatus FewerAxes::write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept
{
    return device_->write(glm::mix(glm::dvec3(0), force_n, axes_.pushes), torque_n_m);
}

} // namespace haptel::runtime
