#include "runtime/effects.h"

#include "runtime/contact.h"
#include "runtime/hand.h"
#include "runtime/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::runtime {

double ObjectEffects::reach_m() const
{
    return std::max({magnet.acts() ? magnet.reach_m : 0.0, damping_n_s_per_m > 0 ? damping_reach_m : 0.0,
                     vibration.acts() ? vibration_reach_m : 0.0});
}

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
        objects_.push_back(has ? std::make_unique<Near>(Near{object.effects, SurfaceDistance(object.surface), {}})
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

void Effects::update(std::size_t object, const Placement& placement, std::span<const Contact> contacts,
                     std::span<const Contact> joined) noexcept
{
    const auto of_tip = [](const Contact& contact) { return contact.along == 0 && !contact.by_shaft; };
    Near& near = *objects_[object];
    const ObjectEffects& effects = near.effects;
    double distance_m = 0;
    glm::dvec3 toward(0);
    if (std::none_of(contacts.begin(), contacts.end(), of_tip)) {
        // What holds the tip holds it out here: a hand in a floor is as far from a wall on it as its proxy.
        const auto holds = std::find_if(joined.begin(), joined.end(), of_tip);
        const glm::dvec3 tip_m =
            placement.to_object(holds == joined.end() ? tip_m_ : holds->proxy_m + probe_radius_m_ * holds->normal);
        const double reach_m = effects.reach_m();
        const uint64_t queries = near.distance.queries(), triangles = near.distance.triangles();
        const auto nearest = reach_m > 0 ? near.distance.within(tip_m, reach_m + probe_radius_m_) : std::nullopt;
        queries_ += near.distance.queries() - queries;
        triangles_ += near.distance.triangles() - triangles;
        distance_m =
            nearest ? std::max(0.0, nearest->distance_m - probe_radius_m_) : std::numeric_limits<double>::infinity();
        if (distance_m > 0 && nearest)
            toward = placement.direction_to_world((nearest->point_m - tip_m) / nearest->distance_m);
    }
    if (effects.magnet.acts()) {
        glm::dvec3 pull_n = effects.magnet.pull_n(distance_m) * toward;
        const double stiffness_n_per_m = scene_.objects[object].material.stiffness_n_per_m / scale_;
        for (const Contact& contact : joined) {
            if (!of_tip(contact)) continue;
            const double across_n = glm::dot(pull_n, contact.normal), held_n = stiffness_n_per_m * contact.depth_m;
            pull_n -= std::copysign(std::min(std::abs(across_n), held_n), across_n) * contact.normal;
        }
        sum_n_ += pull_n;
    }
    const auto share = [&](double reach_m) {
        return distance_m == 0 ? 1.0 : distance_m < reach_m ? 1 - distance_m / reach_m : 0.0;
    };
    damping_n_s_per_m_ += effects.damping_n_s_per_m * share(effects.damping_reach_m);
    vibrate(effects.vibration, near.level, contacts.empty() ? share(effects.vibration_reach_m) : 1, placement);
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
