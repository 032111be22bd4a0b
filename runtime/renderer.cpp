#include "runtime/renderer.h"

#include "runtime/force_model.h"
#include "runtime/shading.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

bool finite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::variant<PointContact, StylusContact> make_contact(ProbeKind kind, const std::shared_ptr<const Surface>& surface)
{
    switch (kind) {
    case ProbeKind::point: return PointContact(surface);
    case ProbeKind::stylus: return StylusContact(surface);
    }
    return PointContact(surface);
}

} // namespace

Renderer::Renderer(std::shared_ptr<const Scene> scene, double device_force_max_n)
    : scene_(std::move(scene))
    , period_s_(1 / scene_->servo.rate_hz)
    , force_limit_n_(device_force_max_n > 0 ? std::min(device_force_max_n, scene_->servo.force_limit_n)
                                            : scene_->servo.force_limit_n)
    , velocity_gain_(1 - std::exp(-2 * 3.14159265358979323846 * velocity_cutoff_hz * period_s_))
{
    objects_.reserve(scene_->objects.size());
    for (const SceneObject& object : scene_->objects) {
        TextureReader reader(*object.texture);
        const uint64_t serial = reader.to().serial;
        objects_.push_back({&object, make_contact(scene_->probe.kind, object.surface), std::move(reader), serial});
    }
}

uint64_t Renderer::reloads() const noexcept
{
    uint64_t sum = 0;
    for (const Touched& touched : objects_) sum += touched.object->texture->newest_serial() - touched.serial_at_start;
    return sum;
}

TickResult Renderer::tick(const DevicePose& pose) noexcept
{
    TickResult result;
    const uint64_t periods = std::max(uint64_t{1}, pose.periods);
    if (std::exchange(started_, true)) period_ += periods;
    result.time_s = static_cast<double>(period_) * period_s_;
    for (Touched& touched : objects_) touched.texture.advance(static_cast<double>(periods) * period_s_);
    if (!objects_.empty()) result.binding = objects_.front().texture.to().serial;
    if (!finite(pose.tip_m) || !finite(pose.tail_m)) {
        has_last_tip_ = false;
        interrupted_ = true;
        result.faults = fault_pose_not_finite;
        return result;
    }
    update_velocity(pose.tip_m, periods);
    result.interrupted = std::exchange(interrupted_, false) || pose.interrupted;
    if (result.interrupted) rise_period_ = period_;

    bool no_query = true;
    for (Touched& touched : objects_) {
        const uint64_t skipped_before = counters(touched).skipped;
        const Contact& contact = update_contact(touched, pose);
        no_query = no_query && counters(touched).skipped > skipped_before;
        if (!contact.touching) {
            touched.friction_share = 0;
            continue;
        }
        const ObjectForce object = force_of(touched, contact);
        result.unlimited_force_n += object.force_n;
        result.faults |= object.faults;
        ++result.contacts;
        if (result.contacts == 1 || contact.depth_m > result.depth_m) {
            result.depth_m = contact.depth_m;
            result.height_m = object.height_m;
            result.binding = touched.texture.to().serial;
        }
    }
    skipped_.free_space += no_query;

    if (!finite(result.unlimited_force_n)) {
        result.unlimited_force_n = glm::dvec3(0);
        result.faults |= fault_force_not_finite;
        interrupted_ = true;
    }
    const double rise_s = scene_->servo.force_rise_s;
    const double rising_s = static_cast<double>(period_ - rise_period_) * period_s_;
    const double risen = rising_s < rise_s ? rising_s / rise_s : 1.0;
    result.force_n = limited(risen * result.unlimited_force_n, force_limit_n_);
    return result;
}

const ContactCounters& Renderer::counters(const Touched& touched) const noexcept
{
    if (const auto* stylus = std::get_if<StylusContact>(&touched.contact)) return stylus->counters();
    return std::get_if<PointContact>(&touched.contact)->counters();
}

const Contact& Renderer::update_contact(Touched& touched, const DevicePose& pose) const noexcept
{
    const Placement& placement = touched.object->placement;
    const Material& material = touched.object->material;
    const Friction friction{material.static_friction * touched.friction_share,
                            material.dynamic_friction * touched.friction_share};
    const glm::dvec3 tip_m = placement.to_object(pose.tip_m);
    if (auto* stylus = std::get_if<StylusContact>(&touched.contact))
        return stylus->update(tip_m, placement.to_object(pose.tail_m), friction);
    return std::get_if<PointContact>(&touched.contact)->update(tip_m, friction);
}

Renderer::ObjectForce Renderer::force_of(Touched& touched, const Contact& contact) const noexcept
{
    const SceneObject& object = *touched.object;
    const Surface& surface = *object.surface;

    SurfacePoint at;
    at.p_m = contact.proxy_m;
    at.time_s = static_cast<double>(period_) * period_s_;
    // What nobody reads is not computed.
    const bool turns = scene_->servo.force.model == ForceModel::displaced && touched.texture.textured() &&
                       surface.normal_turn_max_per_m > 0;
    if (turns || texture_reads(touched.texture) & (HAPTEL_READS_NORMAL | HAPTEL_READS_UV))
        at.shading = shade(surface, contact.face, contact.side, contact.barycentric);
    else
        at.shading.normal = shading_normal(surface, contact.face, contact.side, contact.barycentric);
    if (contact.normal != contact.facet_normal && on_crease(surface, contact.face, contact.side, contact.barycentric)) {
        at.shading.normal = contact.normal;
        at.shading.normal_dp = glm::dmat3(0);
    }

    const TextureSample texture = sample_texture(touched.texture, at);
    const TouchedSurface felt{contact.depth_m, contact.normal, at.shading.normal, at.shading.normal_dp,
                              object.material.stiffness_n_per_m};
    const ModelForce elastic = model_force(scene_->servo.force, felt, texture);
    const double stiffness = felt.stiffness_n_per_m * texture.stiffness_scale;

    ObjectForce result;
    result.height_m = texture.height_m;
    result.faults = texture.faults;
    touched.friction_share =
        contact.depth_m > 0 ? texture.friction_scale * std::min(1.0, elastic.depth_m / contact.depth_m) : 0.0;
    if (elastic.depth_m == 0) return result; // below the base surface, but not yet below the texture

    const glm::dvec3 velocity = object.placement.direction_to_object(velocity_m_per_s_);
    const double approach = -glm::dot(velocity, at.shading.normal);
    const double damping =
        object.material.damping_n_s_per_m * approach * std::min(1.0, elastic.depth_m / full_damping_depth_m);
    const double not_sticky = std::max(damping, -stiffness * elastic.depth_m);

    const glm::dvec3 force = elastic.force_n + stiffness * contact.lag_m + not_sticky * at.shading.normal;
    result.force_n = object.placement.direction_to_world(force);
    return result;
}

void Renderer::update_velocity(const glm::dvec3& tip_m, uint64_t periods) noexcept
{
    // One period: the same bits as ever. Several: the low-pass as if each of them had seen the mean speed.
    const double count = static_cast<double>(periods);
    const double gain = periods == 1 ? velocity_gain_ : 1 - std::pow(1 - velocity_gain_, count);
    if (has_last_tip_) velocity_m_per_s_ += gain * ((tip_m - last_tip_m_) / (count * period_s_) - velocity_m_per_s_);
    // Speeds may overflow where positions do not, and what is not finite would never leave a low-pass again.
    if (!has_last_tip_ || !finite(velocity_m_per_s_)) velocity_m_per_s_ = glm::dvec3(0);
    last_tip_m_ = tip_m;
    has_last_tip_ = true;
}

} // namespace haptel::runtime
