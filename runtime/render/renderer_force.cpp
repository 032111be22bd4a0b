// From the contacts of a tick to the forces of what is touched.
#include "runtime/render/renderer.h"

#include "runtime/force/force_model.h"
#include "runtime/texture/shading.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

// Copied. Made in place, its ones are written in two pieces, and who reads one at once waits until both are in memory.
const TextureSample flat_sample;

// From the finger at the tip to that at the tail.
double along_fingers(const DevicePose& pose, const glm::dvec3& force_n)
{
    const glm::dvec3 along = pose.tail_m - pose.tip_m;
    return along == glm::dvec3(0) ? 0.0 : glm::dot(force_n, glm::normalize(along));
}

glm::dmat3 in_world(const Placement& placement, const glm::dmat3& by_place)
{
    return placement.rotation * by_place * glm::transpose(placement.rotation);
}

Shaft in_object(const Placement& placement, const Shaft& way)
{
    return {placement.direction_to_object(way.tip), placement.direction_to_object(way.tail)};
}

} // namespace

// On the probe at the share `along` of the way from its tip to its tail.
void Renderer::add_force(TickResult& result, const DevicePose& pose, double along,
                         const glm::dvec3& force_n) const noexcept
{
    result.unlimited_force_n += force_n;
    if (probe_.has_tail())
        result.unlimited_torque_n_m +=
            torque_about(result.grip_m, pose.tip_m + along * (pose.tail_m - pose.tip_m), force_n);
    if (probe_.kind == ProbeKind::gripper) result.grip_force_n += (along - 0.5) * along_fingers(pose, force_n);
}

// Felt as the smooth surface for which its facets stand.
bool Renderer::is_smooth(const Surface& surface) const noexcept
{
    return surface.normal_turn_max_per_m > 0 && force_rule_.shading == ForceShading::smooth;
}

// What a tick without contact is spared: the texture where the hand is, and whether there is one.
bool Renderer::feels_in_air(const Body& body, const DevicePose& pose) noexcept
{
    bool textured = false;
    for (const uint32_t object : body.objects.numbers()) {
        Touched& touched = objects_[object];
        const Placement& placement = body.placement_of(*touched.object);
        Contact here;
        here.proxy_m = here.hand_m = placement.to_object(pose.tip_m);
        textured = force_of(body, touched, placement, here).textured || textured;
    }
    return textured;
}

// There where the contact is, in the object's space.
glm::dvec3 Renderer::hand_m_per_s(const Body& body, const Placement& placement, const Contact& contact) const noexcept
{
    const auto in_object = [&](const HandVelocity& own, const HandVelocity& world) {
        return body.motion ? own.m_per_s() : placement.direction_to_object(world.m_per_s());
    };
    glm::dvec3 here = in_object(body.velocity, velocity_);
    if (contact.along > 0) here += contact.along * (in_object(body.tail_velocity, tail_velocity_) - here);
    return here;
}

// To this tick's phase of a vibration, whose frequency may change from tick to tick: no step in force.
void Renderer::swing_on(Touched& touched) noexcept
{
    const uint64_t periods = texture_period_ - std::exchange(touched.swung_period, texture_period_);
    if (touched.swing_hz == 0) return;
    touched.swing_turns =
        std::remainder(touched.swing_turns + touched.swing_hz * static_cast<double>(periods) * period_s_, 1.0);
}

// Along the normal, where the stylus touches; never more than the spring pulls back.
double Renderer::damping_n(const Body& body, double n_s_per_m, const Placement& placement, const Contact& contact,
                           const glm::dvec3& normal, double depth_m, double stiffness_n_per_m) const noexcept
{
    const glm::dvec3 velocity = hand_m_per_s(body, placement, contact);
    const double scale = hand_.workspace.scale, full_per_m = 1 / (scale * full_damping_depth_m);
    const double damping = n_s_per_m / scale * -glm::dot(velocity, normal) * std::min(1.0, full_per_m * depth_m);
    return std::max(damping, -stiffness_n_per_m * depth_m);
}

// Without a texture: of a shaft, and of what is not deep enough to feel one.
ObjectForce Renderer::force_of_facets(const Body& body, const Material& material, const Placement& placement,
                                      const Contact& contact) const noexcept
{
    ObjectForce result;
    const double stiffness = material.stiffness_n_per_m / hand_.workspace.scale;
    result.normal = placement.direction_to_world(contact.normal);
    result.felt_n_per_m = stiffness;
    if (contact.depth_m <= 0) {
        result.felt_m = contact.depth_m;
        result.felt_dp = -result.normal;
        return result;
    }
    const double damping =
        damping_n(body, material.damping_n_s_per_m, placement, contact, contact.normal, contact.depth_m, stiffness);
    result.spring_n = stiffness * contact.depth_m * result.normal;
    result.force_n = result.spring_n + damping * result.normal;
    result.surface_j = stiffness * contact.depth_m * contact.depth_m / 2;
    const glm::dvec2 ends(1 - contact.along, contact.along); // its depth is its push, by which both give way
    result.held_j = glm::dot(ends, ends) * result.surface_j;
    return result;
}

// Of flat facets, and where contact tells a direction of its own, there is one foot.
Foot Renderer::foot_of(Touched& touched, const Contact& contact) const noexcept
{
    const Surface& surface = *touched.object->surface;
    const bool curved =
        surface.normal_turn_max_per_m > 0 && contact.touching && !contact.on_crease && !contact.unsettled;
    const bool smooth = curved && is_smooth(surface);
    Foot foot = smooth   ? smooth_foot(surface, contact, hand_below(contact), touched.lines)
                : curved ? paper_foot(surface, contact)
                         : flat_foot(surface, contact);
    if (foot.share == 0) foot.share = 1; // the flat one
    return foot;
}

ObjectForce Renderer::force_of(const Body& body, Touched& touched, const Placement& placement, const Contact& contact,
                               glm::dmat3* normal_dp) noexcept
{
    // Textures reach up to the base and no further.
    if (contact.by_shaft || (contact.depth_m == 0 && scene_->servo.skips.texture))
        return force_of_facets(body, touched.object->material, placement, contact);
    const Foot foot = foot_of(touched, contact);
    if (normal_dp) *normal_dp = foot.is_flat() ? glm::dmat3(0) : in_world(placement, turning(touched.lines, foot));
    if (foot.share == 1) return force_at(foot, body, touched, placement, contact);
    ObjectForce force = force_at(foot, body, touched, placement, contact);
    const ObjectForce flat = force_at(flat_foot(*touched.object->surface, contact), body, touched, placement, contact);
    const glm::dvec3 share_dp = placement.direction_to_world(foot.share_dp);
    if (normal_dp) *normal_dp *= foot.share;
    force.mix_in(flat, 1 - foot.share, -share_dp);
    return force;
}

// Of the springs, minus the gradient of what is held by both in these shares.
void ObjectForce::mix_in(const ObjectForce& other, double share, const glm::dvec3& share_dp) noexcept
{
    force_n = glm::mix(force_n, other.force_n, share) - (other.surface_j - surface_j) * share_dp;
    spring_n = glm::mix(spring_n, other.spring_n, share) - (other.surface_j - surface_j) * share_dp;
    felt_n_per_m = std::lerp(felt_n_per_m, other.felt_n_per_m, share);
    felt_dp = glm::mix(felt_dp, other.felt_dp, share) + (other.felt_m - felt_m) * share_dp;
    felt_m = std::lerp(felt_m, other.felt_m, share);
    surface_j = std::lerp(surface_j, other.surface_j, share);
    held_j = std::lerp(held_j, other.held_j, share);
    height_m = std::lerp(height_m, other.height_m, share);
    normal = glm::normalize(glm::mix(normal, other.normal, share)); // less than a right angle apart
    static_share = std::lerp(static_share, other.static_share, share);
    dynamic_share = std::lerp(dynamic_share, other.dynamic_share, share);
    grain = mixed(grain, other.grain, share);
    swing_hz = std::lerp(swing_hz, other.swing_hz, share);
    faults |= other.faults;
    textured |= other.textured;
    band_limited |= other.band_limited;
    unmapped |= other.unmapped;
}

TextureSample Renderer::texture_at(const Foot& foot, const Body& body, Touched& touched, const Placement& placement,
                                   const Contact& contact, double stiffness_n_per_m, const Shaded& read) noexcept
{
    SurfacePoint at{foot.at_m, {}, time_s()};
    at.shading.normal = foot.normal;
    if (read.normal_dp || read.uv)
        at.shading = shade(*touched.object->surface, foot.face, foot.side, foot.barycentric, read);
    if (contact.on_crease) {
        at.shading.normal = contact.normal;
        at.shading.normal_dp = glm::dmat3(0);
    }
    if (texture_reads(touched.texture) & HAPTEL_READS_VELOCITY)
        at.velocity_m_per_s = tangential(hand_m_per_s(body, placement, contact), foot.normal);
    at.normal_force_n = stiffness_n_per_m * std::max(0.0, contact.depth_m);
    at.tool_radius_m = probe_.radius_m;
    if (shares_.textures < 1) return mixed({}, sample_texture(touched.texture, at, touched.sample), shares_.textures);
    return sample_texture(touched.texture, at, touched.sample);
}

ObjectForce Renderer::force_at(const Foot& foot, const Body& body, Touched& touched, const Placement& placement,
                               const Contact& contact) noexcept
{
    const SceneObject& object = *touched.object;
    const Surface& surface = *object.surface;
    const double scale = hand_.workspace.scale;
    ObjectForce result;
    const bool textured = touched.texture.textured() && shares_.textures > 0;
    const uint32_t reads = textured ? texture_reads(touched.texture) : 0;
    const bool all = !scene_->servo.skips.mapping, drawn = !surface.uv.empty(),
               turns = surface.normal_turn_max_per_m > 0;
    const Shaded read{all || (reads & (HAPTEL_READS_NORMAL | HAPTEL_READS_CURVATURE)),
                      all || (reads & (HAPTEL_READS_UV | HAPTEL_READS_TANGENT))};
    result.unmapped = (turns && !read.normal_dp) || (drawn && !read.uv);
    const double stiffness = object.material.stiffness_n_per_m / scale;
    const TextureSample texture =
        textured ? texture_at(foot, body, touched, placement, contact, stiffness, read) : flat_sample;
    result.textured = textured;
    result.band_limited =
        textured && (touched.texture.from().binding.band_limited || touched.texture.to().binding.band_limited);
    const ModelForce elastic = model_force(force_rule_, foot, stiffness, texture);
    const double felt_stiffness = stiffness * texture.stiffness_scale;

    result.felt_n_per_m = felt_stiffness;
    result.height_m = texture.height_m;
    result.normal = placement.direction_to_world(foot.normal);
    result.faults = texture.faults;
    const double below = contact.depth_m > 0 ? std::min(1.0, elastic.depth_m / contact.depth_m) : 0.0;
    result.static_share = texture.static_friction_scale * below;
    result.dynamic_share = texture.dynamic_friction_scale * below;
    if (texture.grain.is_there) result.grain = texture.grain;
    if (elastic.depth_m == 0) { // below the base surface, but not yet below the texture
        const bool displaced = force_rule_.model == ForceModel::displaced;
        result.felt_m = displaced ? foot.depth_m + texture.envelope_m : std::min(0.0, foot.depth_m);
        result.felt_dp = placement.direction_to_world(displaced ? foot.felt(texture.gradient) - foot.push : -foot.push);
        return result;
    }

    result.spring_n = placement.direction_to_world(elastic.force_n);
    result.surface_j = felt_stiffness * elastic.depth_m * elastic.depth_m / 2;
    result.held_j = result.surface_j + felt_stiffness * glm::dot(contact.lag_m, contact.lag_m) / 2;
    const double damping = damping_n(body, object.material.damping_n_s_per_m * texture.damping_scale, placement,
                                     contact, foot.normal, elastic.depth_m, felt_stiffness);
    result.swing_hz = texture.vibration_hz;
    double swing_n = 0;
    if (texture.vibration_n > 0) {
        const double most_n = std::min(texture.vibration_n, std::max(0.0, glm::dot(elastic.force_n, foot.normal)));
        if (texture.vibration_hz * period_s_ <= 0.5)
            swing_n = most_n * swing(touched.swing_turns);
        else
            result.faults |= fault_vibration_too_fast;
    }
    const double along_n = std::max(damping + swing_n, -felt_stiffness * elastic.depth_m); // a surface never pulls
    result.force_n =
        result.spring_n + placement.direction_to_world(felt_stiffness * contact.lag_m + along_n * foot.normal);
    return result;
}

void Renderer::render_contacts(Body& body, std::span<const Contact> contacts, std::span<const PartContacts> parts,
                               const DevicePose& pose, TickResult& result, Skipped& skipped) noexcept
{
    if (contacts.size() == 1) {
        const Contact& contact = parts[0].contacts[0];
        Touched& touched = objects_[body.objects.numbers()[parts[0].part]];
        swing_on(touched);
        feel(body, parts[0].part, true, contact, force_of(body, touched, body.placement_of(*touched.object), contact),
             pose, result, skipped);
        return;
    }
    using At = HeldTogether::At;
    const std::span<Row> rows = rows_of(body, contacts, parts);
    const bool stylus = probe_.kind == ProbeKind::stylus; // of the others each end by itself
    const std::array held{HeldTogether(rows, stylus ? At::both : At::tip),
                          stylus ? HeldTogether() : HeldTogether(rows, At::tail)};
    for (Row& row : rows) {
        Touched& touched = objects_[body.objects.numbers()[row.part]];
        if (row.is_first) swing_on(touched);
        feel_row(body, row);
    }
    for (const HeldTogether& end : held) end.push();
    for (const Row& row : rows) { // what presses most first, of a stylus its tip
        feel(body, row.part, row.is_first, row.contact, row.force, pose, result, skipped);
        add_force(result, pose, 0, row.at_ends_n.tip);
        add_force(result, pose, 1, row.at_ends_n.tail);
    }
}

// Friction and damping as if the row held all of the hand, times its share, and what is felt there by how deep the hand
// is: between walls that are nearer to each other than a right angle it pushes by more.
void Renderer::feel_row(const Body& body, Row& row) noexcept
{
    Touched& touched = objects_[body.objects.numbers()[row.part]];
    const auto tell = [&](const ObjectForce& force) {
        const double stiffness = force.felt_n_per_m,
                     pushed_m = stiffness > 0 ? std::sqrt(2 * force.surface_j / stiffness) : 0.0;
        row.felt_m = pushed_m > 0 ? pushed_m : force.felt_m;
        row.felt_dp = pushed_m > 0 ? -force.spring_n / (stiffness * pushed_m) : force.felt_dp;
        row.felt_normal = is_smooth(*touched.object->surface) ? force.normal : row.normal;
        row.felt_direction = Shaft::pushed_at(row.contact.along, row.felt_normal);
    };
    row.force = force_of(body, touched, *row.placement, row.whole(), &row.normal_dp);
    tell(row.force);
    row.force.force_n *= row.share;
    row.force.held_j *= row.share;
    if (row.below_m >= row.contact.depth_m) return;
    Contact there = row.contact;
    there.depth_m = row.below_m;
    tell(force_of(body, touched, *row.placement, there, &row.normal_dp));
}

std::span<Row> Renderer::rows_of(const Body& body, std::span<const Contact> contacts,
                                 std::span<const PartContacts> parts) noexcept
{
    std::size_t count = 0;
    for (const PartContacts& part : parts) {
        Touched& touched = objects_[body.objects.numbers()[part.part]];
        const Placement& placement = body.placement_of(*touched.object);
        std::span<const Contact> of_part = part.contacts;
        if (of_part.size() > 1 && is_smooth(*touched.object->surface)) {
            Shaft way_m; // from the hand to the proxy
            for (const Contact& contact : contacts)
                way_m += contact.depth_m * Shaft::pushed_at(contact.along, contact.normal);
            if (body.objects.joined) way_m = in_object(placement, way_m);
            of_part = smooth_rows_.of(*touched.object->surface, of_part, way_m, touched.lines);
        }
        for (const Contact& contact : of_part.first(std::min(of_part.size(), rows_.size() - count)))
            rows_[count++] = {.part = part.part,
                              .is_first = &contact == of_part.data(),
                              .placement = &placement,
                              .contact = contact,
                              .below_m = contact.depth_m};
    }
    return {rows_.data(), count};
}

// Adds it to what the hand feels.
void Renderer::feel(Body& body, uint32_t part, bool is_first, const Contact& contact, const ObjectForce& force,
                    const DevicePose& pose, TickResult& result, Skipped& skipped) noexcept
{
    Touched& touched = objects_[body.objects.numbers()[part]];
    result.contacts += is_first;
    add_force(result, pose, contact.along, force.force_n);
    result.faults |= force.faults;
    held_j_ += force.held_j;
    skipped.texture = skipped.texture && !force.textured;
    skipped.octaves = skipped.octaves || force.band_limited;
    skipped.mapping = skipped.mapping || force.unmapped;
    if (!contact.by_shaft) {
        const Material& material = touched.object->material;
        MeanFriction& end = contact.along == 0 ? body.tip_friction : body.tail_friction;
        const bool turns = body.objects.joined && force.grain.is_there;
        end.add({material.static_friction * force.static_share, material.dynamic_friction * force.dynamic_share,
                 turns ? turned(force.grain, body.placement_of(*touched.object).rotation) : force.grain},
                material.stiffness_n_per_m * contact.depth_m);
    }
    if (!is_first) return;
    touched.swing_hz = force.swing_hz;
    if (result.contacts > 1 && contact.depth_m <= result.depth_m) return;
    result.depth_m = contact.depth_m;
    result.height_m = force.height_m;
    result.normal = force.normal;
    result.object = body.objects.numbers()[part] + 1;
    result.binding = touched.texture.to().serial;
}

} // namespace haptel::runtime
