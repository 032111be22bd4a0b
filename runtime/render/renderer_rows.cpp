// What several contacts of one probe hold together.
//
// Alone, a contact pushes with a spring: minus the gradient of half the square of how deep the hand is below what is
// felt. Of several at one end of the probe, X is the shortest way from the hand to a place above all of
//
//   n_i . X >= d_i + h_i,
//
// d_i how deep the hand is below facet i, h_i <= 0 by how much lower than it the texture and the smooth surface are.
// What all push together is minus the gradient of |X|^2 / 2: with the push p_i of each, how much of X is along n_i,
//
//   sum of p_i (n_i - grad h_i).
//
// h_i is looked up straight below the place to which the others push the hand, and so it stays where they hold it: of
// what holds little, little, so that nothing steps where a contact begins. The gradient counts all that changes with
// the hand but the turning of n_i where a ball rests on an edge. What that leaves on closed paths is measured in
// tests/runtime/force/closed_paths.cpp.
//
// Friction and damping are felt by shares: of each contact as if it held all of the hand, times what it holds.
#include "runtime/render/renderer.h"

#include "runtime/contact/project.h"
#include "runtime/geometry/rise.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr double exact_within = 1e-9; // of the way from the hand to the proxy

// Of the way from the hand to the proxy: what holds so much of it keeps the hand's places on what else is touched
// still. With five times as much closed paths in smooth valleys give ten times as much.
constexpr double holds_still = 0.05;

// Squared sine of the angle within which facets count as of one direction, 6 degrees: what holds goes over from one to
// the other on so short a way that the force would step.
constexpr double one_direction = 0.01;

bool is_held_at(const Contact& contact, bool tail)
{
    return contact.depth_m > 0 && (contact.along > 0) == tail && !contact.by_shaft && !contact.unsettled;
}

// What one of several contacts holds, of how deep the hand is below what is touched there: two walls at right angles
// hold all of it each, several facets nearly in one plane hold it together. Along the way from the hand to the proxy
// the shares of damping add up to 1, but in grooves narrower than a right angle: more than all of it is held by none.
double share_of(const Contact& contact, const glm::dvec3& way_m)
{
    const double below_m = glm::dot(way_m, contact.normal);
    return contact.depth_m > 0 && contact.depth_m < below_m ? contact.depth_m / below_m : 1.0;
}

} // namespace

// What the others leave of a row's normal, each in so far as it holds.
glm::dvec3 Renderer::left_by_others(const Row& row, std::span<Row* const> rows) noexcept
{
    glm::dmat3 left(1);
    for (const Row* other : rows) {
        if (other == &row || other->held == 0) continue;
        const glm::dvec3 across = left * other->normal;
        const double stays = glm::dot(other->normal, across) + one_direction + (1 / other->held - 1);
        left -= glm::outerProduct(across / stays, across);
    }
    return left * row.normal;
}

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
    const std::array held{held_together(body, rows, false), held_together(body, rows, true)};
    for (Row& row : rows) {
        Touched& touched = objects_[body.objects.number(row.part)];
        if (row.is_first) swing_on(touched);
        row.force = force_of(body, touched, body.placement_of(*touched.object), row.whole());
        row.force.force_n *= row.share;
        row.force.held_j *= row.share;
    }
    for (const HeldTogether& end : held) push_together(end);
    for (const Row& row : rows) // what presses most first, of a stylus its tip
        feel(body, row.part, row.is_first, row.contact, row.force, pose, result, skipped);
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
Renderer::HeldTogether Renderer::held_together(const Body& body, std::span<Row> rows, bool tail) const noexcept
{
    HeldTogether held;
    const auto placement_of = [&](const Row& row) -> const Placement& {
        return body.placement_of(*objects_[body.objects.number(row.part)].object);
    };
    for (Row& row : rows) {
        if (!is_held_at(row.contact, tail)) continue;
        held.way_m += placement_of(row).direction_to_world(row.contact.depth_m * row.contact.normal);
        held.row[held.count++] = &row;
    }
    const double way_m = glm::length(held.way_m);
    if (held.count < 2 || !(way_m > 0)) return {};
    for (Row* row : held.rows()) {
        row->normal = placement_of(*row).direction_to_world(row->contact.normal);
        row->share = share_of(row->contact, placement_of(*row).direction_to_object(held.way_m));
    }
    for (Row* row : held.rows()) row->held = Rise(row->contact.depth_m / (holds_still * way_m)).value;
    for (Row* row : held.rows()) {
        const glm::dvec3 left = left_by_others(*row, held.rows());
        const double alone = glm::dot(row->normal, left);
        const glm::dvec3 depth_dp = -left / alone;
        const double depth_m = row->contact.depth_m, q = depth_m / (holds_still * way_m);
        const Rise rise(q);
        row->still_m = depth_m * rise.value;
        row->still_dp =
            holds_still * q * q * rise.slope / way_m * held.way_m + (rise.value + q * rise.slope) * depth_dp;
        row->off_m = std::sqrt(alone) * depth_m;
        row->off_dp = std::sqrt(alone) * depth_dp;
    }
    for (Row* row : held.rows()) {
        glm::dvec3 moved_m(0);
        for (const Row* other : held.rows())
            if (other != row)
                moved_m += (other->still_m - other->contact.depth_m) * tangential(other->normal, row->normal);
        row->contact.proxy_m += placement_of(*row).direction_to_object(moved_m);
    }
    return held;
}

// By how much what is felt on a row is above its facet, mostly less than 0, and how that changes with the hand's place.
void Renderer::raise(Row& row, const HeldTogether& held) noexcept
{
    const ObjectForce& force = row.force;
    const double stiffness = force.felt_n_per_m,
                 felt_m = stiffness > 0 ? std::sqrt(2 * force.surface_j / stiffness) : 0.0;
    row.raised_m = felt_m > 0 ? felt_m - row.whole().depth_m : force.raised_m;
    const glm::dvec3 below_dp = felt_m > 0 ? row.normal - force.spring_n / (stiffness * felt_m) : force.raised_dp;
    row.raised_dp = below_dp;
    for (const Row* other : held.rows())
        if (other != &row) row.raised_dp += glm::dot(below_dp, tangential(other->normal, row.normal)) * other->still_dp;
    if (!(row.raised_m < 0)) return;
    const double left = std::max(0.0, 1 + row.off_m / row.raised_m);
    row.on_m = -row.raised_m * (1 - left * left);
    row.on_dp = 2 * left * row.off_dp - (left > 0 ? (1 - left) * (1 - left) : 1.0) * row.raised_dp;
}

// Where the others are lower than this row is, the probe may come to it before contact does: up to five times as deep
// as they are it is lower, too, so that it begins without a step, and its force grows at most by 0.4 faster than its
// depth.
void Renderer::ease_in(const HeldTogether& held) noexcept
{
    double all_m = 0;
    glm::dvec3 all_dp(0);
    for (const Row* row : held.rows()) {
        all_m += row->on_m;
        all_dp += row->on_dp;
    }
    for (Row* row : held.rows()) {
        const double others_m = all_m - row->on_m + row->raised_m,
                     left = others_m > 0 ? 1 - row->off_m / (5 * others_m) : 0;
        if (left <= 0) continue;
        const glm::dvec3 others_dp = all_dp - row->on_dp + row->raised_dp;
        row->raised_m -= others_m * left * left;
        row->raised_dp -= (left * left + 2 * (1 - left) * left) * others_dp - 0.4 * left * row->off_dp;
    }
}

void Renderer::push_together(const HeldTogether& held) noexcept
{
    const double way_m = glm::length(held.way_m);
    const auto is_facet = [&](const Row* row) {
        return std::fabs(row->raised_m) <= exact_within * way_m && glm::length(row->raised_dp) <= exact_within;
    };
    for (Row* row : held.rows()) raise(*row, held);
    if (std::ranges::all_of(held.rows(), is_facet)) return;
    ease_in(held);
    std::array<ShaftRow, CreaseRows::rows_most> planes;
    for (std::size_t i = 0; i < held.count; ++i) {
        const Row& row = *held.row[i];
        planes[i] = {row.normal, glm::dot(row.normal, held.way_m) + row.raised_m, 0};
    }
    const Projection<Shaft> at =
        project(std::span<const ShaftRow>(planes.data(), held.count), {}, exact_within * way_m);
    double pushes_m = 0;
    for (std::size_t i = 0; i < at.count; ++i) pushes_m += at.push[i];
    const double told = std::min(1.0, opposed_most * glm::length(at.at.tip) / pushes_m);
    for (std::size_t i = 0; i < held.count; ++i) {
        Row& row = *held.row[i];
        const auto active = std::find(at.active.begin(), at.active.begin() + at.count, i);
        const double push_m = active == at.active.begin() + at.count
                                  ? 0.0
                                  : at.push[static_cast<std::size_t>(active - at.active.begin())];
        ObjectForce& force = row.force;
        const glm::dvec3 spring_n = force.felt_n_per_m * push_m * (row.normal - row.raised_dp),
                         more_n = told * (spring_n - row.share * force.spring_n);
        force.force_n += more_n;
        const double along_n = glm::dot(force.force_n, force.normal);
        if (along_n < 0) force.force_n -= std::max(along_n, -glm::length(more_n)) * force.normal; // never pulls
    }
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
