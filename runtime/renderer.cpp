#include "runtime/renderer.h"

#include "runtime/force_model.h"
#include "runtime/shading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace haptel::runtime {

namespace {

// An object is left alone if it is farther away than this: the hand needs several ticks to come near it, and what
// rounding does to coordinates is nothing beside it.
double far_enough_m(const DevicePose& pose, double way_m)
{
    const glm::dvec3 farthest = glm::max(glm::abs(pose.tip_m), glm::abs(pose.tail_m));
    return std::max({1e-6, 8 * way_m, 1e-6 * std::max({farthest.x, farthest.y, farthest.z})});
}

} // namespace

Renderer::Renderer(std::shared_ptr<const Scene> scene, const HandSettings& hand)
    : scene_(std::move(scene))
    , hand_(hand)
    , probe_(hand.probe.value_or(scene_->probe))
    , period_s_(1 / scene_->servo.rate_hz)
    , force_limit_n_(hand.force_max_n > 0 ? std::min(hand.force_max_n, scene_->servo.force_limit_n)
                                          : scene_->servo.force_limit_n)
    , effects_(*scene_, hand_)
    , reach_(surroundings(*scene_, probe_.radius_m))
    , waiting_(scene_->servo.wait_for_small_force_n > 0)
    , velocity_(period_s_)
    , tail_velocity_(period_s_)
{
    objects_.reserve(scene_->objects.size());
    for (const SceneObject& object : scene_->objects) {
        TextureReader reader(*object.texture);
        const uint64_t serial = reader.to().serial;
        objects_.push_back({&object, ProbeContact(probe_, object.surface, scene_->servo.skips.free_space),
                            std::move(reader), serial, object.placement, HandVelocity(period_s_),
                            HandVelocity(period_s_)});
    }
}

std::vector<Surroundings> Renderer::surroundings(const Scene& scene, double probe_radius_m)
{
    std::vector<Surroundings> all;
    for (const SceneObject& object : scene.objects) {
        const Surface& surface = *object.surface;
        const glm::dvec3 middle = 0.5 * surface.box_minimum_m + 0.5 * surface.box_maximum_m;
        const double radius_m =
            glm::distance(surface.box_minimum_m, middle) + probe_radius_m + object.effects.reach_m();
        all.push_back({object.placement.to_world(middle),
                       object.motion ? std::numeric_limits<double>::infinity() : radius_m * (1 + 1e-6)});
    }
    return all;
}

uint64_t Renderer::reloads() const noexcept
{
    uint64_t sum = reloads_before_;
    for (const Touched& touched : objects_) sum += touched.object->texture->newest_serial() - touched.serial_at_start;
    return sum;
}

TickResult Renderer::tick(const DevicePose& pose) noexcept
{
    const Workspace& workspace = hand_.workspace;
    if (!workspace.moves()) return feel(pose);
    TickResult result = feel(workspace.to_scene(pose));
    result.force_n = workspace.direction_to_hand(result.force_n);
    result.unlimited_force_n = workspace.direction_to_hand(result.unlimited_force_n);
    result.torque_n_m = workspace.torque_to_hand(result.torque_n_m);
    result.unlimited_torque_n_m = workspace.torque_to_hand(result.unlimited_torque_n_m);
    result.grip_m = workspace.to_hand(result.grip_m);
    return result;
}

// The same in the scene's space, with stiffness and damping stated for the hand.
TickResult Renderer::feel(const DevicePose& pose) noexcept
{
    TickResult result;
    const uint64_t periods = std::max(uint64_t{1}, pose.periods);
    if (std::exchange(started_, true)) period_ += periods;
    result.time_s = static_cast<double>(period_) * period_s_;
    texture_period_ += periods;
    if (!objects_.empty()) {
        advance_texture(objects_.front());
        result.binding = objects_.front().texture.to().serial;
    }
    for (const uint32_t object : reach_.awake()) advance_texture(objects_[object]);
    if (!finite(pose.tip_m) || !finite(pose.tail_m)) {
        velocity_.lose_hand();
        tail_velocity_.lose_hand();
        effects_.lose_hand();
        sent_n_ = left_n_ = sent_n_m_ = left_n_m_ = glm::dvec3(0);
        for (Touched& touched : objects_) touched.velocity.lose_hand(), touched.tail_velocity.lose_hand();
        interrupted_ = true;
        result.faults = fault_pose_not_finite;
        return result;
    }
    velocity_.update(pose.tip_m, periods);
    const bool has_tail = probe_.has_tail();
    if (has_tail) tail_velocity_.update(pose.tail_m, periods);
    const glm::dvec3 grip_m = result.grip_m = has_tail ? probe_.grip_of(pose.tip_m, pose.tail_m) : pose.tip_m;
    const auto along_fingers = [&](const glm::dvec3& force_n) { // from the tip's to the tail's
        const glm::dvec3 along = pose.tail_m - pose.tip_m;
        return along == glm::dvec3(0) ? 0.0 : glm::dot(force_n, glm::normalize(along));
    };
    result.interrupted = std::exchange(interrupted_, false) || pose.interrupted;
    if (result.interrupted) {
        rise_period_ = period_;
        waiting_ = scene_->servo.wait_for_small_force_n > 0;
        swapped_ = false;
        left_n_ = left_n_m_ = glm::dvec3(0);
        effects_.lose_hand();
    }
    if (effects_.act()) effects_.begin(pose.tip_m, result.time_s, periods);

    felt_.reset();
    double way_m = 0;
    if (last_pose_)
        way_m = std::max(glm::distance(pose.tip_m, last_pose_->tip_m), glm::distance(pose.tail_m, last_pose_->tail_m));
    const double near_m = far_enough_m(pose, way_m);
    reach_.go(way_m, pose.tip_m, pose.tail_m, near_m);
    skipped_.objects += reach_.asleep();
    bool no_query = true, textured = false, band_limited = false, unmapped = false;
    for (std::size_t i = 0; i < reach_.awake().size(); ++i) {
        const uint32_t number = reach_.awake()[i];
        Touched& touched = objects_[number];
        if (touched.asleep) wake(touched);
        const ContactCounters& counters = touched.contact.counters();
        const uint64_t skipped = counters.skipped, queries = counters.sweeps, triangles = counters.triangles_tested,
                       steps = counters.walk_steps;
        const std::span<const Contact> contacts = update_contact(touched, pose, periods);
        no_query = no_query && counters.skipped > skipped;
        work_.queries += counters.sweeps - queries;
        work_.triangles += counters.triangles_tested - triangles;
        work_.steps += counters.walk_steps - steps;
        if (effects_.of(number)) effects_.update(number, touched.placement, contacts);
        touched.friction_share = 0;
        if (contacts.empty()) {
            textured = textured || (!scene_->servo.skips.texture && feels_in_air(touched, pose));
            if (const double gap_m = gap_to_sleep_m(number, pose, near_m); gap_m > 0) {
                touched.asleep = true;
                reach_.sleep(number, gap_m);
                --i;
            }
            continue;
        }
        ++result.contacts;
        bool ends_felt = false;
        for (const Contact& contact : contacts) { // what presses most first, of a stylus its tip
            const ObjectForce force = force_of(touched, contact);
            result.unlimited_force_n += force.force_n;
            if (has_tail)
                result.unlimited_torque_n_m +=
                    torque_about(grip_m, pose.tip_m + contact.along * (pose.tail_m - pose.tip_m), force.force_n);
            if (probe_.kind == ProbeKind::gripper)
                result.grip_force_n += (contact.along - 0.5) * along_fingers(force.force_n);
            result.faults |= force.faults;
            textured = textured || force.textured;
            band_limited = band_limited || force.band_limited;
            unmapped = unmapped || force.unmapped;
            if (!contact.by_shaft && !std::exchange(ends_felt, true)) touched.friction_share = force.friction_share;
            if (&contact != contacts.data()) continue;
            if (result.contacts > 1 && contact.depth_m <= result.depth_m) continue;
            felt_ = {touched.placement.to_world(contact.proxy_m), touched.placement.direction_to_world(contact.normal),
                     contact.along};
            result.depth_m = contact.depth_m;
            result.height_m = force.height_m;
            result.binding = touched.texture.to().serial;
        }
    }
    last_pose_ = pose;
    skipped_.free_space += no_query;
    skipped_.texture += !textured;
    skipped_.octaves += band_limited;
    skipped_.mapping += unmapped;
    if (effects_.act()) {
        const glm::dvec3 effects_n = effects_.force_n(); // once: its medium lives a tick
        result.unlimited_force_n += effects_n;
        if (has_tail) result.unlimited_torque_n_m += torque_about(grip_m, pose.tip_m, effects_n);
    }
    send(result, std::max(glm::distance(pose.tip_m, grip_m), glm::distance(pose.tail_m, grip_m)));
    return result;
}

// What of the force and the torque goes to the hand. `lever_m`: of the end that is farther from the grip. Contacts that
// push against each other may add up to a torque without a force: it is limited by what the largest force has there.
void Renderer::send(TickResult& result, double lever_m) noexcept
{
    if (!finite(result.unlimited_force_n) || !finite(result.unlimited_torque_n_m) ||
        !std::isfinite(result.grip_force_n)) {
        result.unlimited_force_n = result.unlimited_torque_n_m = glm::dvec3(0);
        result.grip_force_n = 0;
        result.faults |= fault_force_not_finite;
        interrupted_ = true;
    }
    const double small_n = scene_->servo.wait_for_small_force_n;
    const auto small = [&](const glm::dvec3& force_n, const glm::dvec3& torque_n_m) {
        return glm::length(force_n) <= small_n && glm::length(torque_n_m) <= small_n * lever_m;
    };
    if (std::exchange(swapped_, false)) {
        rise_period_ = left_period_ = period_;
        left_n_ = interrupted_ ? glm::dvec3(0) : sent_n_;
        left_n_m_ = interrupted_ ? glm::dvec3(0) : sent_n_m_;
        waiting_ = waiting_ || (small_n > 0 && !small(result.unlimited_force_n - computed_n_,
                                                      result.unlimited_torque_n_m - computed_n_m_));
    }
    computed_n_ = result.unlimited_force_n;
    computed_n_m_ = result.unlimited_torque_n_m;
    if (waiting_) {
        waiting_ = !small(result.unlimited_force_n, result.unlimited_torque_n_m) || interrupted_;
        rise_period_ = period_;
        result.waiting = waiting_;
    }
    const double rise_s = scene_->servo.force_rise_s;
    const auto risen_since = [&](uint64_t period) {
        const double rising_s = static_cast<double>(period_ - period) * period_s_;
        return rising_s < rise_s ? rising_s / rise_s : 1.0;
    };
    const double risen = waiting_ ? 0.0 : risen_since(rise_period_);
    glm::dvec3 force_n = risen * result.unlimited_force_n, torque_n_m = risen * result.unlimited_torque_n_m;
    if (left_n_ != glm::dvec3(0) || left_n_m_ != glm::dvec3(0)) {
        const double gone = risen_since(left_period_);
        force_n += (1 - gone) * left_n_;
        torque_n_m += (1 - gone) * left_n_m_;
        if (gone == 1) left_n_ = left_n_m_ = glm::dvec3(0);
    }
    result.force_n = limited(force_n, force_limit_n_);
    result.grip_force_n = std::clamp(risen * result.grip_force_n, -force_limit_n_, force_limit_n_);
    if (torque_n_m != glm::dvec3(0)) {
        const double length_n = glm::length(force_n);
        result.torque_n_m = length_n > force_limit_n_ ? force_limit_n_ / length_n * torque_n_m : torque_n_m;
        const double sent = glm::length(result.torque_n_m), most = force_limit_n_ * lever_m;
        if (sent > most) result.force_n *= most / sent, result.torque_n_m *= most / sent;
    }
    sent_n_ = result.force_n;
    sent_n_m_ = result.torque_n_m;
}

ContactWork Renderer::work() const noexcept
{
    ContactWork all = work_;
    all.queries += effects_.queries();
    all.triangles += effects_.triangles();
    return all;
}

void Renderer::between_ticks() noexcept
{
    // Now and then, in turn: so that nobody keeps a texture that is to be freed.
    if (!objects_.empty() && texture_period_ % 8 == 0) advance_texture(objects_[texture_period_ / 8 % objects_.size()]);
    for (const uint32_t object : reach_.awake()) work_.read_ahead += objects_[object].contact.read_ahead();
}

ProbePose Renderer::in_object(const Touched& touched, const DevicePose& pose) noexcept
{
    return {touched.placement.to_object(pose.tip_m), touched.placement.to_object(pose.tail_m)};
}

void Renderer::advance_texture(Touched& touched) noexcept
{
    const uint64_t periods = texture_period_ - std::exchange(touched.texture_period, texture_period_);
    if (periods > 0) touched.texture.advance(static_cast<double>(periods) * period_s_);
}

// Takes the contact to where the hand was in the tick before: nothing lay on its way.
void Renderer::wake(Touched& touched) noexcept
{
    touched.asleep = false;
    advance_texture(touched);
    touched.contact.follow(in_object(touched, *last_pose_));
}

// How far the hand must go before an object that it does not touch is looked at again; 0: look at it every tick.
double Renderer::gap_to_sleep_m(uint32_t number, const DevicePose& pose, double near_m) const noexcept
{
    const Touched& touched = objects_[number];
    if (touched.object->motion || !scene_->servo.skips.objects) return 0;
    const ProbePose probe = in_object(touched, pose);
    const double gap_m = touched.contact.gap_m(probe) - effects_.awake_within_m(number);
    const glm::dvec3 farthest = glm::abs(probe.tip_m); // in its space, where coordinates may be larger
    return gap_m > std::max({near_m, 1e-6 * farthest.x, 1e-6 * farthest.y, 1e-6 * farthest.z}) ? gap_m : 0;
}

// To where the object is now.
void Renderer::move(Touched& touched) const noexcept
{
    const double time_s = static_cast<double>(period_) * period_s_;
    const auto placement = touched.object->motion->at(time_s);
    if (placement && finite(*placement)) touched.placement = *placement;
}

std::span<const Contact> Renderer::update_contact(Touched& touched, const DevicePose& pose, uint64_t periods) noexcept
{
    if (touched.object->motion) {
        move(touched);
        touched.velocity.update(touched.placement.to_object(pose.tip_m), periods);
        if (probe_.has_tail()) touched.tail_velocity.update(touched.placement.to_object(pose.tail_m), periods);
    }
    const Material& material = touched.object->material;
    const Friction friction{material.static_friction * touched.friction_share,
                            material.dynamic_friction * touched.friction_share};
    return touched.contact.update(in_object(touched, pose), friction);
}

// What a tick without contact is spared: the texture where the hand is, and whether there is one.
bool Renderer::feels_in_air(const Touched& touched, const DevicePose& pose) const noexcept
{
    Contact here;
    here.proxy_m = here.hand_m = in_object(touched, pose).tip_m;
    return force_of(touched, here).textured;
}

// Along the normal, where the stylus touches; never more than the spring pulls back.
double Renderer::damping_n(const Touched& touched, const Contact& contact, const glm::dvec3& normal, double depth_m,
                           double stiffness_n_per_m) const noexcept
{
    const auto in_object = [&](const HandVelocity& own, const HandVelocity& world) {
        return touched.object->motion ? own.m_per_s() : touched.placement.direction_to_object(world.m_per_s());
    };
    glm::dvec3 velocity = in_object(touched.velocity, velocity_);
    if (contact.along > 0) velocity += contact.along * (in_object(touched.tail_velocity, tail_velocity_) - velocity);
    const double scale = hand_.workspace.scale;
    const double damping = touched.object->material.damping_n_s_per_m / scale * -glm::dot(velocity, normal) *
                           std::min(1.0, depth_m / (scale * full_damping_depth_m));
    return std::max(damping, -stiffness_n_per_m * depth_m);
}

Renderer::ObjectForce Renderer::force_of(const Touched& touched, const Contact& contact) const noexcept
{
    const SceneObject& object = *touched.object;
    const Surface& surface = *object.surface;
    const double scale = hand_.workspace.scale;
    const Skips& skips = scene_->servo.skips;
    ObjectForce result;
    if (contact.depth_m == 0 && skips.texture)
        return result; // the highest texture reaches up to the base and no further
    if (contact.by_shaft) {
        const double stiffness = object.material.stiffness_n_per_m / scale;
        const glm::dvec3 force =
            (stiffness * contact.depth_m + damping_n(touched, contact, contact.normal, contact.depth_m, stiffness)) *
            contact.normal;
        result.force_n = touched.placement.direction_to_world(force);
        return result;
    }

    SurfacePoint at;
    at.p_m = contact.proxy_m;
    at.time_s = static_cast<double>(period_) * period_s_;
    const uint32_t reads = texture_reads(touched.texture);
    const bool curved = surface.normal_turn_max_per_m > 0, drawn = !surface.uv.empty();
    const bool turns = scene_->servo.force.model == ForceModel::displaced && touched.texture.textured() && curved;
    const Shaded read{!skips.mapping || turns || (reads & HAPTEL_READS_NORMAL),
                      !skips.mapping || (reads & HAPTEL_READS_UV)};
    result.unmapped = (curved && !read.normal_dp) || (drawn && !read.uv);
    at.shading = shade(surface, contact.face, contact.side, contact.barycentric, read);
    if (contact.normal != contact.facet_normal && on_crease(surface, contact.face, contact.side, contact.barycentric)) {
        at.shading.normal = contact.normal;
        at.shading.normal_dp = glm::dmat3(0);
    }

    const TextureSample texture = sample_texture(touched.texture, at);
    result.textured = touched.texture.textured();
    result.band_limited = touched.texture.from().binding.band_limited || touched.texture.to().binding.band_limited;
    const TouchedSurface felt{contact.depth_m,
                              contact.normal,
                              at.shading.normal,
                              at.shading.normal_dp,
                              object.material.stiffness_n_per_m / scale,
                              probe_.radius_m};
    const ModelForce elastic = model_force(scene_->servo.force, felt, texture);
    const double stiffness = felt.stiffness_n_per_m * texture.stiffness_scale;

    result.height_m = texture.height_m;
    result.faults = texture.faults;
    result.friction_share =
        contact.depth_m > 0 ? texture.friction_scale * std::min(1.0, elastic.depth_m / contact.depth_m) : 0.0;
    if (elastic.depth_m == 0) return result; // below the base surface, but not yet below the texture

    const double damping = damping_n(touched, contact, at.shading.normal, elastic.depth_m, stiffness);
    const glm::dvec3 force = elastic.force_n + stiffness * contact.lag_m + damping * at.shading.normal;
    result.force_n = touched.placement.direction_to_world(force);
    return result;
}

} // namespace haptel::runtime
