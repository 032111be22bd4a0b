#include "runtime/render/renderer.h"

#include "runtime/geometry/finite.h"
#include "runtime/scene/validation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

// Forces of effects have no spring. Where they are left over by a scene that is gone they fade like those of this one.
constexpr double effect_stiffness_n_per_m = 1000;

std::vector<Body> make_bodies(const Scene& scene, const ProbeSettings& probe)
{
    std::vector<Body> all;
    for (const BodyObjects& objects : bodies_of(scene)) all.emplace_back(scene, objects, probe);
    return all;
}

std::vector<BoundingSphere> bounding_spheres(const Scene& scene, const std::vector<Body>& bodies, double probe_radius_m)
{
    std::vector<BoundingSphere> all;
    for (const Body& body : bodies) all.push_back(bounding_sphere_of(scene, body, probe_radius_m));
    return all;
}

} // namespace

Renderer::Renderer(std::shared_ptr<const Scene> scene, const HandSettings& hand)
    : refused_(validate(scene.get(), hand))
    , scene_(refused_.empty() ? std::move(scene) : std::make_shared<const Scene>())
    , hand_(refused_.empty() ? hand : HandSettings())
    , workspace_moves_(hand_.workspace.moves())
    , probe_(hand_.probe.value_or(scene_->probe))
    , force_rule_(scene_->servo.force)
    , period_s_(1 / scene_->servo.rate_hz)
    , force_limit_n_(hand_.force_max_n > 0 ? std::min(hand_.force_max_n, scene_->servo.force_limit_n)
                                           : scene_->servo.force_limit_n)
    , bodies_(make_bodies(*scene_, probe_))
    , effects_(*scene_, hand_)
    , sleep_queue_(bounding_spheres(*scene_, bodies_, probe_.radius_m), scene_->servo.skips.objects)
    , waiting_(scene_->servo.wait_for_small_force_n > 0)
    , velocity_(period_s_)
    , tail_velocity_(period_s_)
{
    if (hand_.slopes_only) force_rule_.model = ForceModel::lateral;
    for (Body& body : bodies_) {
        body.asleep = scene_->servo.skips.objects;
        if (!body.bounded) continue;
        turn_max_rad_per_s_ = std::max(turn_max_rad_per_s_, body.bounded->turn_rad_per_s);
        if (!history_) history_.emplace(period_s_);
    }
    objects_.reserve(scene_->objects.size());
    for (const SceneObject& object : scene_->objects) objects_.push_back({&object, TextureReader(*object.texture)});
}

TickResult Renderer::tick(const DevicePose& pose) noexcept
{
    if (!refused_.empty()) return {.faults = fault_scene_refused};
    const Workspace& workspace = hand_.workspace;
    if (!workspace_moves_) return tick_in_scene(pose);
    TickResult result = tick_in_scene(workspace.to_scene(pose));
    result.force_n = workspace.direction_to_hand(result.force_n);
    result.normal = workspace.direction_to_hand(result.normal);
    result.unlimited_force_n = workspace.direction_to_hand(result.unlimited_force_n);
    result.torque_n_m = workspace.torque_to_hand(result.torque_n_m);
    result.unlimited_torque_n_m = workspace.torque_to_hand(result.unlimited_torque_n_m);
    result.grip_m = workspace.to_hand(result.grip_m);
    return result;
}

// The same in the scene's space, with stiffness and damping stated for the hand.
TickResult Renderer::tick_in_scene(DevicePose pose) noexcept
{
    TickResult result;
    const uint64_t periods = std::max(uint64_t{1}, pose.periods);
    if (std::exchange(started_, true)) period_ += periods;
    result.time_s = time_s();
    texture_period_ += periods;
    if (!objects_.empty()) {
        advance_texture(objects_.front());
        result.binding = objects_.front().texture.to().serial;
    }
    for (const uint32_t body : sleep_queue_.awake())
        if (!bodies_[body].asleep) advance_textures(bodies_[body]);
    if (!finite(pose.tip_m) || !finite(pose.tail_m)) {
        velocity_.lose_hand();
        tail_velocity_.lose_hand();
        effects_.lose_hand();
        if (history_) history_->lose_hand();
        sent_ = left_ = {};
        for (const uint32_t body : sleep_queue_.awake()) { // who sleeps knows of no hand
            bodies_[body].velocity.lose_hand();
            bodies_[body].tail_velocity.lose_hand();
            bodies_[body].aim_m = glm::dvec3(0);
        }
        interrupted_ = true;
        result.faults = fault_pose_not_finite;
        return result;
    }
    const bool has_tail = probe_.has_tail();
    last_tail_m_ = pose.tail_m;
    if (!has_tail) pose.tail_m = pose.tip_m; // or who lies along it would be near
    velocity_.update(pose.tip_m, periods);
    if (has_tail) tail_velocity_.update(pose.tail_m, periods);
    if (history_) history_->add(period_, pose.tip_m, pose.tail_m);
    const glm::dvec3 grip_m = result.grip_m = has_tail ? probe_.grip_of(pose.tip_m, pose.tail_m) : pose.tip_m;
    result.interrupted = std::exchange(interrupted_, false) || pose.interrupted;
    if (result.interrupted) {
        rise_period_ = period_;
        waiting_ = scene_->servo.wait_for_small_force_n > 0;
        swapped_ = false;
        left_ = {};
        effects_.lose_hand();
    }
    if (pose.degradation != Degradation::none || shares_ != Shares()) fade_shares(pose.degradation, periods);
    const bool effects_act = effects_.act() && shares_.effects > 0;
    if (effects_act) effects_.begin(pose.tip_m, result.time_s, periods);

    held_j_ = 0;
    const double way = way_m(pose);
    near_m_ = far_enough_m(pose.tip_m, pose.tail_m, way);
    if (turned_rad() > turn_max_rad) sleep_queue_.wake_who_turns();
    sleep_queue_.go(way, pose.tip_m, pose.tail_m, near_m_);
    Skipped skipped;
    skipped.query = scene_->servo.skips.free_space;
    skipped_.objects += objects_.size();
    for (std::size_t i = 0; i < sleep_queue_.awake().size(); ++i) {
        const uint32_t number = sleep_queue_.awake()[i];
        Body& body = bodies_[number];
        if (!take_pose(body, pose, periods)) continue;
        skipped_.objects -= body.objects.numbers().size();
        work_.objects += body.objects.numbers().size();
        ProbePose probe = body.pose_of(pose);
        if (effects_act && body.objects.joined) probe.tip_m += shares_.effects * body.aim_m;
        const uint64_t sweeps = work_.sweeps;
        std::span<const Contact> contacts =
            update_contact(body, probe, {body.tip_friction.mean, body.tail_friction.mean});
        skipped.query = skipped.query && contacts.empty() && work_.sweeps == sweeps;
        if (!body.contact.settled()) result.faults |= fault_contact_unfinished;
        contacts = crease_rows_.of(*body.objects.surface(*scene_), contacts);
        if (body.bounded) track_velocity(number, pose, periods, !contacts.empty());
        const PartContacts alone{0, contacts};
        const std::span<const PartContacts> parts =
            body.objects.joined ? by_part_.of(*scene_, *body.objects.joined, contacts) : std::span(&alone, 1);
        body.aim_m = glm::dvec3(0);
        if (effects_act) update_effects(body, contacts, parts);
        body.tip_friction = {};
        body.tail_friction = {};
        if (contacts.empty()) {
            skipped.texture = skipped.texture && (scene_->servo.skips.texture || !feels_in_air(body, pose));
            if (sleeps(number, pose)) --i;
            continue;
        }
        render_contacts(body, contacts, parts, pose, result, skipped);
    }
    const OnHand& left = swapped_ ? sent_ : left_;
    const double left_work_j = last_pose_ && left != OnHand() ? work_j(left, *last_pose_, pose) : 0.0;
    last_pose_ = pose;
    last_pose_period_ = period_;
    skipped_.free_space += skipped.query;
    skipped_.texture += skipped.texture;
    skipped_.octaves += skipped.octaves;
    skipped_.mapping += skipped.mapping;
    if (effects_act) {
        const glm::dvec3 effects_n = shares_.effects * effects_.force_n(); // once: its medium lives a tick
        add_force(result, pose, 0, effects_n);
        held_j_ += glm::dot(effects_n, effects_n) * hand_.workspace.scale / (2 * effect_stiffness_n_per_m);
    }
    limit_and_send(result, std::max(glm::distance(pose.tip_m, grip_m), glm::distance(pose.tail_m, grip_m)),
                   left_work_j);
    return result;
}

// Counted.
std::span<const Contact> Renderer::update_contact(Body& body, const ProbePose& pose,
                                                  const EndsFriction& friction) noexcept
{
    const std::span<const Contact> contacts = body.contact.update(pose, friction);
    static_cast<ContactCounters&>(work_) = work_ + body.contact.spent();
    return contacts;
}

void Renderer::between_ticks() noexcept
{
    // Now and then, in turn: so that nobody keeps a texture that is to be freed.
    if (!objects_.empty() && texture_period_ % 8 == 0) advance_texture(objects_[texture_period_ / 8 % objects_.size()]);
    for (std::size_t i = 0; i < sleep_queue_.awake().size(); ++i) {
        const uint32_t number = sleep_queue_.awake()[i];
        if (bodies_[number].asleep) continue;
        work_.read_ahead += bodies_[number].contact.read_ahead(scene_->servo.skips.free_space);
        // How far it is free may be known by now.
        if (last_pose_ && !bodies_[number].contact.touches() && sleeps(number, *last_pose_)) --i;
    }
}

void Renderer::advance_texture(Touched& touched) noexcept
{
    const uint64_t periods = texture_period_ - std::exchange(touched.texture_period, texture_period_);
    if (periods > 0) touched.texture.advance(static_cast<double>(periods) * period_s_);
}

void Renderer::advance_textures(const Body& body) noexcept
{
    for (const uint32_t object : body.objects.numbers()) advance_texture(objects_[object]);
}

// How far who turns within bounds has done so since the last pose.
double Renderer::turned_rad() const noexcept
{
    return turn_max_rad_per_s_ * (time_s() - time_s(last_pose_period_));
}

// Of the hand since the last pose, with how much longer it looks to who turns: a stylus far away sweeps along.
double Renderer::way_m(const DevicePose& pose) const noexcept
{
    if (!last_pose_) return 0;
    const double way = farther_m({pose.tip_m, pose.tail_m}, {last_pose_->tip_m, last_pose_->tail_m});
    if (turn_max_rad_per_s_ == 0) return way;
    return way + std::min(turned_rad(), turn_max_rad) * glm::distance(pose.tip_m, pose.tail_m);
}

// Where the probe was in the tick before, in the body's space as it was then.
ProbePose Renderer::pose_before(Body& body) const noexcept
{
    if (body.asleep && body.bounded) body.move(time_s(last_pose_period_));
    return body.pose_of(*last_pose_);
}

// To where a body and the hand are now. False: it sleeps on. One of which nobody knows where it can go is not among
// those that SleepQueue leaves alone, and cannot be touched while in its own space the hand is out of the ball around
// it, and its way into this tick is.
bool Renderer::take_pose(Body& body, const DevicePose& pose, uint64_t periods) noexcept
{
    if (!body.motion && !body.asleep) return true;
    const bool put_down = body.asleep && !last_pose_; // by the contact, where the hand is
    const ProbePose before = body.asleep && last_pose_ ? pose_before(body) : ProbePose();
    if (body.motion) body.move(time_s());
    if (body.motion && !body.bounded) {
        const ProbePose now = body.pose_of(pose);
        body.velocity.update(now.tip_m, periods);
        if (probe_.has_tail()) body.tail_velocity.update(now.tail_m, periods);
        if (body.asleep) {
            const double way = put_down ? 0.0 : farther_m(now, before);
            if (lies_beyond(body, now, far_enough_m(now.tip_m, now.tail_m, way))) return false;
        }
    }
    if (!body.asleep) return true;
    wake(body);
    if (!put_down) body.contact.follow(before); // to where the hand was in the tick before: nothing lay on its way
    return true;
}

void Renderer::wake(Body& body) noexcept
{
    body.asleep = false;
    advance_textures(body);
}

// Puts a body that is awake to sleep where the hand is far enough. True: it is not among the awake any more.
bool Renderer::sleeps(uint32_t number, const DevicePose& pose) noexcept
{
    Body& body = bodies_[number];
    const double gap = gap_to_sleep_m(number, pose);
    body.asleep = gap > 0;
    if (!body.asleep || (body.motion && !body.bounded)) return false;
    sleep_queue_.sleep(number, gap);
    return true;
}

// How far the hand must go before a body that it does not touch is looked at again; 0: look at it every tick.
double Renderer::gap_to_sleep_m(uint32_t number, const DevicePose& pose) const noexcept
{
    if (!scene_->servo.skips.objects) return 0;
    const Body& body = bodies_[number];
    const ProbePose probe = body.pose_of(pose);
    double awake_within_m = 0;
    for (const uint32_t object : body.objects.numbers())
        awake_within_m = std::max(awake_within_m, effects_.awake_within_m(object));
    double gap = body.contact.gap_m(probe) - awake_within_m;
    if (body.bounded) gap = std::min(gap, gap_m(sleep_queue_.around(number), pose.tip_m, pose.tail_m));
    // In its space coordinates may be larger.
    return gap > std::max(near_m_, far_enough_m(probe.tip_m, probe.tail_m, 0)) ? gap : 0;
}

// Of a body that moves within bounds. Whether it slept does not matter: it is told from the poses of late when it is
// touched, and forgotten where it may fall asleep.
void Renderer::track_velocity(uint32_t number, const DevicePose& pose, uint64_t periods, bool touching) noexcept
{
    Body& body = bodies_[number];
    const auto update = [&](const glm::dvec3& tip_m, const glm::dvec3& tail_m, uint64_t since) {
        body.velocity.update(body.placement.to_object(tip_m), since);
        if (probe_.has_tail()) body.tail_velocity.update(body.placement.to_object(tail_m), since);
    };
    if (body.velocity.has_hand()) {
        if (touching || !(gap_m(sleep_queue_.around(number), pose.tip_m, pose.tail_m) > 0))
            update(pose.tip_m, pose.tail_m, periods);
        else
            body.velocity.lose_hand(), body.tail_velocity.lose_hand();
    } else if (touching) {
        history_->each([&](const HandHistory::Entry& entry) {
            body.move(time_s(entry.period));
            update(entry.tip_m, entry.tail_m, entry.periods);
        });
    }
}

void Renderer::update_effects(Body& body, std::span<const Contact> contacts,
                              std::span<const PartContacts> parts) noexcept
{
    const std::span<const uint32_t> numbers = body.objects.numbers();
    const glm::dvec3 held_out_m = body.placement.direction_to_world(Effects::held_out_m(contacts));
    // Of what presses the tip most; where nothing does, what would press it least.
    double stiffness_n_per_m = 0, most_m = 0;
    for (const uint32_t number : numbers)
        stiffness_n_per_m = std::max(stiffness_n_per_m, scene_->objects[number].material.stiffness_n_per_m);
    for (const PartContacts& part : parts)
        for (const Contact& contact : part.contacts) {
            if (contact.by_shaft || contact.along != 0 || !(contact.depth_m > most_m)) continue;
            most_m = contact.depth_m;
            stiffness_n_per_m = scene_->objects[numbers[part.part]].material.stiffness_n_per_m;
        }
    for (uint32_t part = 0; part < numbers.size(); ++part) {
        if (!effects_.of(numbers[part])) continue;
        const Placement& placement = body.placement_of(scene_->objects[numbers[part]]);
        const auto touched =
            std::find_if(parts.begin(), parts.end(), [&](const PartContacts& of) { return of.part == part; });
        if (body.objects.joined || held_out_m == glm::dvec3(0)) // nothing pulls to what holds the tip
            body.aim_m += effects_.pull(numbers[part], placement, held_out_m, stiffness_n_per_m, work_);
        effects_.update(numbers[part], placement,
                        touched == parts.end() ? std::span<const Contact>() : touched->contacts);
    }
}

} // namespace haptel::runtime
