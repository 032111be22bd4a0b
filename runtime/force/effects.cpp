#include "runtime/force/effects.h"

#include "runtime/contact/contact.h"
#include "runtime/hand/hand.h"
#include "runtime/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::runtime {

namespace {

bool of_tip(const Contact& contact)
{
    return contact.along == 0 && !contact.by_shaft;
}

} // namespace

Effects::Effects(const Scene& scene, const HandSettings& hand)
    : scene_(scene)
    , period_s_(1 / scene.servo.rate_hz)
    , probe_radius_m_(hand.probe.value_or(scene.probe).radius_m)
    , scale_(hand.workspace.scale)
    , act_(!scene.regions.empty())
    , region_levels_(scene.regions.size())
    , trail_(period_s_, trail_stiffness_n_per_m / scale_)
{
    for (const SceneObject& object : scene.objects) {
        const bool has = object.effects.act();
        act_ = act_ || has;
        objects_.push_back(has ? std::make_unique<Near>(Near{object.effects, SurfaceDistance(object.surface), {}, {}})
                               : nullptr);
    }
}

double Effects::awake_within_m(std::size_t object) const noexcept
{
    if (!of(object)) return 0;
    const Near& near = *objects_[object];
    return near.level.sounds() ? std::numeric_limits<double>::infinity() : near.effects.reach_m();
}

void Effects::begin(const glm::dvec3& tip_m, double time_s, uint64_t periods) noexcept
{
    tip_m_ = tip_m;
    time_s_ = time_s;
    periods_ = periods;
    sum_n_ = glm::dvec3(0);
    damping_n_s_per_m_ = 0;
    for (std::size_t i = 0; i < scene_.regions.size(); ++i) {
        const Region& region = scene_.regions[i];
        const double share = region.share_at(tip_m);
        damping_n_s_per_m_ += share * region.damping_n_s_per_m;
        vibrate(region.vibration, region_levels_[i], share, region.placement);
    }
}

glm::dvec3 Effects::pull(std::size_t object, const Placement& placement, const glm::dvec3& held_out_m,
                         double stiffness_n_per_m, CollisionCount& count) noexcept
{
    Near& near = *objects_[object];
    near.distance_m = std::numeric_limits<double>::infinity();
    const double reach_m = near.effects.reach_m();
    if (reach_m == 0) return glm::dvec3(0);
    const glm::dvec3 tip_m = placement.to_object(tip_m_ + held_out_m);
    const auto nearest = near.distance.within(tip_m, reach_m + probe_radius_m_, count);
    if (!nearest) return glm::dvec3(0);
    near.distance_m = std::max(0.0, nearest->distance_m - probe_radius_m_);
    if (!near.effects.magnet.acts() || near.distance_m == 0) return glm::dvec3(0);
    const glm::dvec3 toward = placement.direction_to_world((nearest->point_m - tip_m) / nearest->distance_m);
    const double pull_n = near.effects.magnet.pull_n(near.distance_m);
    sum_n_ += pull_n * toward;
    // A magnet that is steeper than what holds the proxy would throw it to and fro.
    const Magnet& magnet = near.effects.magnet;
    const double steepest_n_per_m = std::max(stiffness_n_per_m / scale_, 4 * magnet.force_n / magnet.reach_m);
    return std::min(pull_n / steepest_n_per_m, near.distance_m) * toward;
}

void Effects::update(std::size_t object, const Placement& placement, std::span<const Contact> contacts) noexcept
{
    Near& near = *objects_[object];
    const ObjectEffects& effects = near.effects;
    const bool touches = std::any_of(contacts.begin(), contacts.end(), of_tip);
    const auto share = [&](double within_m) {
        return touches ? 1.0 : near.distance_m < within_m ? 1 - near.distance_m / within_m : 0.0;
    };
    damping_n_s_per_m_ += effects.damping_n_s_per_m * share(effects.damping_reach_m);
    vibrate(effects.vibration, near.level, contacts.empty() ? share(effects.vibration_reach_m) : 1, placement);
}

glm::dvec3 Effects::held_out_m(std::span<const Contact> contacts) noexcept
{
    glm::dvec3 out_m(0);
    for (const Contact& contact : contacts)
        if (of_tip(contact)) out_m += contact.depth_m * contact.normal + contact.lag_m;
    return out_m;
}

glm::dvec3 Effects::force_n() noexcept
{
    return sum_n_ + trail_.update(tip_m_, damping_n_s_per_m_ / scale_, periods_);
}

void Effects::vibrate(const Vibration& vibration, VibrationLevel& level, double share,
                      const Placement& placement) noexcept
{
    if (!vibration.acts()) return;
    const double now = level.update(share, static_cast<double>(periods_) * period_s_);
    if (now > 0) sum_n_ += now * vibration.swing_n(time_s_) * placement.direction_to_world(vibration.direction);
}

} // namespace haptel::runtime
