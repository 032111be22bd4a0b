#include "runtime/force/effects.h"

#include "runtime/contact/contact.h"
#include "runtime/hand/hand.h"
#include "runtime/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace haptel::runtime {

namespace {

bool of_tip(const Contact& contact)
{
    return contact.along == 0 && !contact.by_shaft;
}

// What contacts leave of a pull, each taking along its normal up to its depth times the stiffness: all that they can of
// it together, to which they come in turns.
glm::dvec3 not_held_n(glm::dvec3 pull_n, std::span<const Contact> contacts, double stiffness_n_per_m)
{
    constexpr int turns = 32;
    std::array<double, 16> held_n{};
    for (int turn = 0; turn < turns; ++turn)
        for (std::size_t i = 0; i < contacts.size() && i < held_n.size(); ++i) {
            if (!of_tip(contacts[i])) continue;
            const double most_n = stiffness_n_per_m * contacts[i].depth_m;
            const double held = std::clamp(held_n[i] + glm::dot(pull_n, contacts[i].normal), -most_n, most_n);
            pull_n -= (held - held_n[i]) * contacts[i].normal;
            held_n[i] = held;
        }
    return pull_n;
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
    Near& near = *objects_[object];
    const ObjectEffects& effects = near.effects;
    double distance_m = 0;
    glm::dvec3 toward(0);
    if (std::none_of(contacts.begin(), contacts.end(), of_tip)) {
        // What holds the tip holds it out here: a hand in a floor is as far from a wall on it as its proxy.
        const glm::dvec3 tip_m = placement.to_object(held_out_m(joined));
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
        sum_n_ += not_held_n(pull_n, joined, stiffness_n_per_m);
    }
    const auto share = [&](double reach_m) {
        return distance_m == 0 ? 1.0 : distance_m < reach_m ? 1 - distance_m / reach_m : 0.0;
    };
    damping_n_s_per_m_ += effects.damping_n_s_per_m * share(effects.damping_reach_m);
    vibrate(effects.vibration, near.level, contacts.empty() ? share(effects.vibration_reach_m) : 1, placement);
}

// Where what holds the tip holds it: a ball by its middle, whatever its way there is divided among.
glm::dvec3 Effects::held_out_m(std::span<const Contact> joined) const noexcept
{
    glm::dvec3 middle_m = tip_m_;
    for (const Contact& contact : joined) {
        if (!of_tip(contact)) continue;
        if (probe_radius_m_ == 0) return contact.proxy_m;
        middle_m += contact.depth_m * contact.normal + contact.lag_m;
    }
    return middle_m;
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
