// One scene in the place of another while a hand is in it.
#include "runtime/renderer.h"

#include <limits>
#include <unordered_map>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

// A body that lies elsewhere by at most this, where the hand is, was moved under the hand and goes on touching it; one
// that lies farther away is another one.
constexpr double nudge_m = 1e-3;

// Above the place that was touched, from where the hand is put down on what is there now.
constexpr double lifted_m = 1e-5;

double distance_m(const Placement& a, const Placement& b)
{
    double sum = glm::distance(a.position_m, b.position_m);
    for (int i = 0; i < 3; ++i) sum += glm::distance(a.rotation[i], b.rotation[i]); // lever arms of a metre
    return sum;
}

} // namespace

Renderer::Renderer(std::shared_ptr<const Scene> scene, const HandSettings& hand, const Scene& before)
    : Renderer(std::move(scene), hand)
{
    const ProbeSettings probe = hand.probe.value_or(before.probe);
    was_.assign(bodies_.size(), none);
    if (probe.kind != probe_.kind || probe.radius_m != probe_.radius_m || probe.length_m != probe_.length_m) return;

    // The same surface makes the same body, nearer ones first.
    const std::vector<BodyObjects> old = bodies_of(before);
    std::unordered_map<const Surface*, std::vector<uint32_t>> by_surface;
    for (uint32_t i = 0; i < old.size(); ++i) by_surface[old[i].surface(before).get()].push_back(i);
    for (uint32_t i = 0; i < bodies_.size(); ++i) {
        const BodyObjects& now = bodies_[i].objects;
        const auto candidates = by_surface.find(now.surface(*scene_).get());
        if (candidates == by_surface.end()) continue;
        auto nearest = candidates->second.end();
        double least_m = std::numeric_limits<double>::infinity();
        for (auto candidate = candidates->second.begin(); candidate != candidates->second.end(); ++candidate) {
            const double away_m = distance_m(old[*candidate].placement(before), now.placement(*scene_));
            if (away_m < least_m) least_m = away_m, nearest = candidate;
        }
        if (nearest == candidates->second.end()) continue;
        was_[i] = *nearest;
        candidates->second.erase(nearest);
    }
}

void Renderer::take_over(Renderer& before) noexcept
{
    started_ = before.started_;
    period_ = before.period_;
    texture_period_ = before.texture_period_;
    interrupted_ = before.interrupted_;
    waiting_ = waiting_ && before.waiting_;
    skipped_ = before.skipped_;
    work_ = before.work();
    reloads_before_ = before.reloads();
    last_pose_ = before.last_pose_;
    velocity_ = before.velocity_;
    tail_velocity_ = before.tail_velocity_;
    sent_ = before.sent_;
    computed_n_ = before.computed_n_;
    computed_n_m_ = before.computed_n_m_;
    felt_ = before.felt_;
    swapped_ = true;
    for (Touched& touched : objects_) touched.texture_period = texture_period_;
    if (!last_pose_) return;

    DevicePose lifted = *last_pose_;
    if (before.felt_) { // where it was touched, a little above
        const double lift_m = probe_.radius_m + lifted_m * hand_.workspace.scale;
        const glm::dvec3 shaft = last_pose_->tail_m - last_pose_->tip_m;
        const glm::dvec3 shift =
            before.felt_->point_m + lift_m * before.felt_->normal - (last_pose_->tip_m + before.felt_->along * shaft);
        lifted.tip_m += shift;
        lifted.tail_m += shift;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        Body& body = bodies_[i];
        if (body.motion) body.move(time_s());
        Body* old = i < was_.size() && was_[i] != none ? &before.bodies_[was_[i]] : nullptr;
        if (old && old->asleep) before.wake(*old);
        const auto moved_m = [&](const glm::dvec3& p) {
            return glm::distance(body.placement.to_object(p), old->placement.to_object(p));
        };
        const double nudge = nudge_m * hand_.workspace.scale;
        if (old && moved_m(last_pose_->tip_m) <= nudge && moved_m(last_pose_->tail_m) <= nudge) {
            std::swap(body.contact, old->contact);
            std::swap(body.velocity, old->velocity);
            std::swap(body.tail_velocity, old->tail_velocity);
            body.tip_friction = old->tip_friction;
            body.tail_friction = old->tail_friction;
        } else {
            body.contact.update(body.pose_of(lifted), {});
        }
    }
}

} // namespace haptel::runtime
