// One scene in the place of another while a hand is in it.
#include "runtime/render/renderer.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

// A body that lies elsewhere by at most this, where the hand is, was moved under the hand and goes on touching it; one
// that lies farther away is another one.
constexpr double nudge_m = 1e-3;

// From the place where the probe was held, off what held it there, the least first: surfaces that are built anew round
// otherwise, and may have grown or moved a little. Not farther: something else may be there.
constexpr double off_m[] = {0, 1e-5, 1e-4, 1e-3};
constexpr double settled_m = off_m[1], farthest_off_m = off_m[3];

double distance_m(const Placement& a, const Placement& b)
{
    double sum = glm::distance(a.position_m, b.position_m);
    for (int i = 0; i < 3; ++i) sum += glm::distance(a.rotation[i], b.rotation[i]); // lever arms of a metre
    return sum;
}

bool share_an_object(const BodyObjects& a, const BodyObjects& b)
{
    return std::ranges::find_first_of(a.numbers(), b.numbers()) != a.numbers().end();
}

} // namespace

Renderer::Renderer(std::shared_ptr<const Scene> scene, const HandSettings& hand, const Scene& before)
    : Renderer(std::move(scene), hand)
{
    if (!refused_.empty()) return;
    const ProbeSettings probe = hand.probe.value_or(before.probe);
    was_.assign(bodies_.size(), none);
    if (probe.kind != probe_.kind || probe.radius_m != probe_.radius_m || probe.length_m != probe_.length_m) return;

    // The same surface makes the same body, nearer ones first.
    const std::vector<BodyObjects> old = bodies_of(before);
    std::unordered_map<const Surface*, std::vector<uint32_t>> by_surface;
    for (uint32_t i = 0; i < old.size(); ++i) by_surface[old[i].surface(before).get()].push_back(i);
    for (uint32_t i = 0; i < bodies_.size(); ++i) {
        const BodyObjects& now = bodies_[i].objects;
        std::vector<uint32_t>& candidates = by_surface[now.surface(*scene_).get()];
        const auto nearest = std::ranges::min_element(candidates, {}, [&](uint32_t number) {
            return distance_m(old[number].placement(before), now.placement(*scene_));
        });
        if (nearest == candidates.end()) continue;
        was_[i] = *nearest;
        candidates.erase(nearest);
    }
}

void Renderer::take_over(Renderer& before) noexcept
{
    started_ = before.started_;
    period_ = before.period_;
    interrupted_ = before.interrupted_;
    waiting_ = waiting_ && before.waiting_;
    shares_ = before.shares_;
    skipped_ = before.skipped_;
    work_ = before.work_;
    last_pose_ = before.last_pose_;
    last_pose_period_ = before.last_pose_period_;
    if (history_ && before.history_) history_ = before.history_;
    velocity_ = before.velocity_;
    tail_velocity_ = before.tail_velocity_;
    sent_ = before.sent_;
    computed_ = before.computed_;
    swapped_ = true;
    if (!last_pose_) return;
    last_tail_m_ = before.last_tail_m_;
    last_pose_->tail_m = probe_.has_tail() ? last_tail_m_ : last_pose_->tip_m;

    HeldBodies held;
    for (const uint32_t number : before.sleep_queue_.awake()) {
        Body& body = before.bodies_[number];
        if (body.asleep) continue;
        const double way_m = farthest_held_m(body, before);
        if (way_m == 0) continue;
        held.within_m = std::max(held.within_m, way_m);
        if (held.count < held.body.size()) held.body[held.count++] = &body;
    }
    const double nudge = nudge_m * hand_.workspace.scale;
    const auto goes_on = [&](const Body& body, const Body& old) {
        const auto moved_m = [&](const glm::dvec3& p) {
            return glm::distance(body.placement.to_object(p), old.placement.to_object(p));
        };
        return moved_m(last_pose_->tip_m) <= nudge && moved_m(last_pose_->tail_m) <= nudge;
    };
    // Who is farther away than any way on which the hand is held off something neither touches it nor is met on the
    // way back to where it was held: such a body sleeps, as one that the hand has not come near yet.
    const double near_m = held.within_m + nudge + far_enough_m(last_pose_->tip_m, last_pose_->tail_m, 0);
    sleep_queue_.go(0, last_pose_->tip_m, last_pose_->tail_m, near_m);
    was_.resize(bodies_.size(), none);              // which allocates only for who was not made for this
    for (const uint32_t i : sleep_queue_.awake()) { // the others first: they look at what the old bodies hold
        Body& body = bodies_[i];
        if (body.motion) body.move(time_s());
        Body* const old = was_[i] == none ? nullptr : &before.bodies_[was_[i]];
        const ProbePose old_pose = old && old->asleep ? before.pose_before(*old) : ProbePose();
        if (old && !goes_on(body, *old)) was_[i] = none;
        if (body.asleep && body.motion && !body.bounded && lies_beyond(body, body.pose_of(*last_pose_), near_m))
            continue;
        if (body.asleep) wake(body);
        work_.objects += body.objects.numbers().size();
        if (was_[i] == none) {
            put_down(body, before, held);
        } else if (old->asleep) {
            before.wake(*old);
            old->contact.follow(old_pose);
        }
    }
    for (const uint32_t i : sleep_queue_.awake()) {
        if (was_[i] == none) continue;
        Body &body = bodies_[i], &old = before.bodies_[was_[i]];
        std::swap(body.velocity, old.velocity);
        std::swap(body.tail_velocity, old.tail_velocity);
        if (body.asleep) continue;
        std::swap(body.contact, old.contact);
        body.tip_friction = old.tip_friction;
        body.tail_friction = old.tail_friction;
    }
}

// How far an old body holds the probe off the hand at most, tried off what it touches included; 0: it does not.
double Renderer::farthest_held_m(const Body& old, const Renderer& before) const noexcept
{
    const ProbePose hand = old.pose_of(*last_pose_);
    double farthest_m = 0;
    for (const double off : off_m) {
        const auto at = old.contact.held(hand, grown_since_m(before) + off * hand_.workspace.scale);
        if (!at) return 0;
        farthest_m = std::max(farthest_m, farther_m(*at, hand));
    }
    return farthest_m;
}

double Renderer::grown_since_m(const Renderer& before) const noexcept
{
    return std::max(0.0, probe_.radius_m - before.probe_.radius_m);
}

// Each of the old bodies held the probe somewhere, on the free side of itself: from there the hand comes to what this
// one is now. Objects that the new scene numbers alike count as the same ones: the place where one of them held the
// probe may be inside another. Where none can hold it as it did the hand is put down where it is. A ball that what has
// grown reaches into touches it as a smaller one: it goes out of that, or it would push too little until it had left.
void Renderer::put_down(Body& body, const Renderer& before, const HeldBodies& held) noexcept
{
    const ProbePose hand = body.pose_of(*last_pose_);
    const double grown_m = grown_since_m(before);
    update_contact(body, hand, {});
    const double gap_m = body.contact.gap_m(hand);
    const auto come = [&](const Body& old) {
        return update_contact(body, hand, {old.tip_friction.mean, old.tail_friction.mean}).size();
    };
    const auto come_from = [&](const ProbePose& start, const Body& old) {
        body.contact.reset();
        update_contact(body, start, {});
        return come(old);
    };
    double least_m = std::numeric_limits<double>::infinity(); // from where it was held
    ProbePose best;
    const Body* best_old = nullptr;
    for (uint32_t i = 0; i < held.count; ++i) {
        const Body& old = *held.body[i];
        if (objects_.size() == before.objects_.size() && !share_an_object(body.objects, old.objects)) continue;
        const ProbePose old_hand = old.pose_of(*last_pose_);
        for (const double off : off_m) {
            const auto at = old.contact.held(old_hand, grown_m + off * hand_.workspace.scale);
            const ProbePose start = body.pose_of(old.in_scene(*at));
            if (gap_m > farther_m(start, hand)) break;
            if (come_from(start, old) == 0) continue;
            const double from_there_m =
                farther_m(old.in_scene(*old.contact.held(old_hand, 0)), body.in_scene(*body.contact.held(hand, 0)));
            if (from_there_m < least_m) least_m = from_there_m, best = start, best_old = &old;
            if (from_there_m <= settled_m * hand_.workspace.scale) break;
        }
    }
    if (best_old) {
        come_from(best, *best_old);
        if (body.contact.move_out(farthest_off_m * hand_.workspace.scale)) come(*best_old);
        body.tip_friction = best_old->tip_friction;
        body.tail_friction = best_old->tail_friction;
    } else {
        body.contact.reset();
        update_contact(body, hand, {});
    }
}

} // namespace haptel::runtime
