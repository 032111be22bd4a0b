// What several contacts of one probe hold together.
//
// Alone, a contact pushes with a spring: minus the gradient of phi(hand), half the square of how deep the hand is. Of
// several at one end of the probe, each should feel the hand where the others have pushed it:
//
//   push i = -grad phi_i(x - push i),   x = hand + sum of all pushes
//
// For psi_i(x) = phi_i(x - push i) - |push i|^2 / 2 has the gradient -push i, so |x - hand|^2 / 2 + sum of psi_i(x) is
// stationary at x, and the sum of all pushes is minus its gradient by the hand: a potential, whatever phi_i are. On
// flat facets x is the proxy and the pushes are those of the contacts. A smooth surface is a little beside its facets,
// so each is laid anew as a plane: where it is, and as it is inclined, for the hand below the proxy. What this one step
// leaves on closed paths is measured in tests/runtime/force/closed_paths.cpp. More steps leave less, but not where the
// hand is as deep as the surface is round: there they would not settle, and the force would step from tick to tick.
//
// Textures, friction and damping are felt by shares: of each contact as if it held all of the hand, times what it
// holds.
#include "runtime/render/renderer.h"

#include "runtime/contact/project.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr double exact_within = 1e-9; // of the way from the hand to the proxy

// Of how the depth changes along its normal. It is nearly 1, but less where the shares of a smooth and a flat foot
// change.
constexpr double least_slope = 0.5;

bool is_held_at(const Contact& contact, bool tail)
{
    return (contact.along > 0) == tail && !contact.by_shaft && !contact.unsettled;
}

// What one of several contacts holds, of how deep the hand is below what is touched there: two walls at right angles
// hold all of it each, several facets nearly in one plane hold it together. Along the way from the hand to the proxy
// the shares of damping add up to 1, but in grooves narrower than a right angle: more than all of it is held by none.
double share_of(const Contact& contact, const glm::dvec3& way_m)
{
    const double below_m = glm::dot(way_m, contact.normal);
    return contact.depth_m > 0 && contact.depth_m < below_m ? contact.depth_m / below_m : 1.0;
}

// Minus the gradient of half the square of `depth_m`.
struct BarePush {
    glm::dvec3 push_m;
    double depth_m;
};

BarePush bare_push(const Foot& foot, const Contact& contact)
{
    const double depth_m = std::max(0.0, foot.depth_m);
    if (foot.share == 1) return {depth_m * foot.push, depth_m};
    const double s = foot.share, half = depth_m * depth_m / 2, half_flat = contact.depth_m * contact.depth_m / 2;
    return {s * depth_m * foot.push + (1 - s) * contact.depth_m * contact.normal - (half - half_flat) * foot.share_dp,
            std::sqrt(2 * std::lerp(half_flat, half, s))};
}

} // namespace

void Renderer::render_contacts(Body& body, std::span<const Contact> contacts, std::span<const PartContacts> parts,
                               const DevicePose& pose, TickResult& result, Skipped& skipped) noexcept
{
    if (contacts.size() == 1) {
        const Contact& contact = parts[0].contacts[0];
        Touched& touched = objects_[body.objects.number(parts[0].part)];
        swing_on(touched);
        feel(body, parts[0].part, true, contact, force_of(body, touched, body.placement_of(*touched.object), contact),
             pose, result, skipped);
        return;
    }
    const std::span<Row> rows = rows_of(body, contacts, parts);
    for (const bool tail : {false, true}) hold_together(body, rows, tail);
    for (const Row& row : rows) { // what presses most first, of a stylus its tip
        Touched& touched = objects_[body.objects.number(row.part)];
        if (row.is_first) swing_on(touched);
        ObjectForce force = force_of(body, touched, body.placement_of(*touched.object), row.whole());
        force.force_n *= row.share;
        if (row.bare_m > 0) { // as much of it as of the spring is felt, below a texture and by its stiffness
            const glm::dvec3 more_n = 2 * force.surface_j / (row.bare_m * row.bare_m) * row.more_m;
            force.force_n += more_n;
            const double along_n = glm::dot(force.force_n, force.normal);
            if (along_n < 0) force.force_n -= std::max(along_n, -glm::length(more_n)) * force.normal; // never pulls
        }
        force.held_j *= row.share;
        feel(body, row.part, row.is_first, row.contact, force, pose, result, skipped);
    }
}

std::span<Renderer::Row> Renderer::rows_of(const Body& body, std::span<const Contact> contacts,
                                           std::span<const PartContacts> parts) noexcept
{
    std::size_t count = 0;
    for (const PartContacts& part : parts) {
        Touched& touched = objects_[body.objects.number(part.part)];
        std::span<const Contact> of_part = part.contacts;
        if (of_part.size() > 1 && is_smooth(*touched.object->surface)) {
            std::array<glm::dvec3, 2> way_m{}; // from the hand to the proxy, of the tip and the tail
            for (const Contact& contact : contacts)
                if (!contact.by_shaft) way_m[contact.along > 0] += contact.depth_m * contact.normal;
            if (body.objects.joined)
                for (glm::dvec3& way : way_m) way = body.placement_of(*touched.object).direction_to_object(way);
            of_part = smooth_rows_.of(*touched.object->surface, of_part, way_m, probe_.radius_m, touched.lines);
        }
        for (const Contact& contact : of_part.first(std::min(of_part.size(), rows_.size() - count)))
            rows_[count++] = {.part = part.part, .is_first = &contact == of_part.data(), .contact = contact};
    }
    return {rows_.data(), count};
}

// Of one end of the probe.
void Renderer::hold_together(const Body& body, std::span<Row> rows, bool tail) noexcept
{
    constexpr std::size_t most = CreaseRows::rows_most;
    std::array<Row*, most> held;
    std::array<glm::dvec3, most> bare_m; // of each alone, world frame
    std::array<ShaftRow, most> planes;
    std::size_t count = 0;
    glm::dvec3 way_m(0); // from the hand to the proxy
    const auto placement_of = [&](const Row& row) -> const Placement& {
        return body.placement_of(*objects_[body.objects.number(row.part)].object);
    };
    for (Row& row : rows) {
        if (!is_held_at(row.contact, tail)) continue;
        way_m += placement_of(row).direction_to_world(row.contact.depth_m * row.contact.normal);
        held[count++] = &row;
    }
    if (count < 2) return;
    bool all_flat = true;
    double off_m = 0; // by which pushes on the smooth surface differ from those on its facets
    for (std::size_t i = 0; i < count; ++i) {
        Row& row = *held[i];
        const Placement& placement = placement_of(row);
        Touched& touched = objects_[body.objects.number(row.part)];
        row.share = share_of(row.contact, placement.direction_to_object(way_m));
        const Contact whole = row.whole();
        const bool smooth = is_smooth(*touched.object->surface);
        const Foot foot = smooth ? foot_of(touched, whole) : flat_foot(*touched.object->surface, whole);
        const auto [push_m, depth_m] = bare_push(foot, whole);
        row.bare_m = depth_m;
        bare_m[i] = placement.direction_to_world(row.share * push_m);
        off_m += glm::distance(push_m * row.share, row.contact.depth_m * row.contact.normal);
        all_flat = all_flat && foot.is_flat();
        // Of the hand below the proxy it is `depth_m` over the slope away. Its push is `slope` times as long as the
        // hand is deep where the others push it, so it ends farther out than there; alone, at all of `push_m`.
        const double length_m = glm::length(push_m),
                     slope = length_m > 0 ? std::max(least_slope, length_m / depth_m) : 1.0;
        const glm::dvec3 normal = length_m > 0 ? push_m / length_m : whole.normal;
        planes[i].normal = placement.direction_to_world(normal);
        planes[i].offset = glm::dot(planes[i].normal, way_m) - whole.depth_m * glm::dot(normal, whole.normal) +
                           depth_m / slope + (1 - 1 / (slope * slope)) * row.share * length_m;
    }
    if (all_flat) return;
    // The others may be so far beside their facets that they need a row before the probe touches it: up to twice as
    // deep it takes part less, so that it begins without a step, and its force grows at most by half faster than its
    // depth.
    for (std::size_t i = 0; i < count; ++i) planes[i].offset -= std::max(0.0, off_m - held[i]->contact.depth_m / 2);
    const Projection<Shaft> at =
        project(std::span<const ShaftRow>(planes.data(), count), {}, exact_within * glm::length(way_m));
    double pushes_m = 0;
    for (std::size_t i = 0; i < at.count; ++i) pushes_m += at.push[i];
    const double told = std::min(1.0, opposed_most * glm::length(at.at.tip) / pushes_m);
    for (std::size_t i = 0; i < count; ++i) held[i]->more_m = -told * bare_m[i];
    for (std::size_t i = 0; i < at.count; ++i)
        held[at.active[i]]->more_m += told * at.push[i] * planes[at.active[i]].normal;
}

// Adds it to what the hand feels.
void Renderer::feel(Body& body, uint32_t part, bool is_first, const Contact& contact, const ObjectForce& force,
                    const DevicePose& pose, TickResult& result, Skipped& skipped) noexcept
{
    Touched& touched = objects_[body.objects.number(part)];
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
    result.object = body.objects.number(part) + 1;
    result.binding = touched.texture.to().serial;
}

} // namespace haptel::runtime
