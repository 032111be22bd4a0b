// What several contacts of one probe hold together.
//
// Alone, a contact pushes with a spring: minus the gradient of half the square of how deep the hand is below what is
// felt. Of several at one end of the probe, X is the shortest way from the hand to a place above all of
//
//   N_i . X >= N_i . a_i + D_i.
//
// On i is felt what is below the place at the way a_i from the hand, to which the others push it: so that stays where
// they hold it; of what holds little, little, and nothing steps where a contact begins. D_i is how deep the hand would
// be there below what is felt, and N_i its normal: that of the smooth surface, if facets stand for one, which turns
// with the place and does not step. Of a stylus X is the way of both its ends, and N_i . X that of the place which
// touches.
//
// What all push together is minus the gradient of |X|^2 / 2: the sum over the rows of their pushes p_i, how much of X
// is along N_i, times the gradient of N_i . (X - a_i) - D_i, X kept. Left out is how the normals of facets, which tell
// a_i, turn where a ball rolls over an edge and with the shaft of a stylus; and where flat facets are felt by a share,
// how N_i turns with that. This is what is left on closed paths (tests/runtime/force/closed_paths.cpp).
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

// Squared sine of the angle within which facets count as of one direction, 6 degrees (up to 8 of a shaft): what holds
// goes over from one to the other on so short a way that the force would step.
constexpr double one_direction = 0.01;

// A row is eased in until it is so many times as deep as it would begin too early: while that stays, its force grows by
// at most 2 / 5 faster than its depth.
constexpr double eased_over = 5;

// What one of several contacts holds, of how deep the hand is below what is touched there: two walls at right angles
// hold all of it each, several facets nearly in one plane hold it together. Along the way from the hand to the proxy
// the shares of damping add up to 1, but in grooves narrower than a right angle: more than all of it is held by none.
double share_of(const Contact& contact, double below_m)
{
    return contact.depth_m < below_m ? contact.depth_m / below_m : 1.0;
}

Shaft in_object(const Placement& placement, const Shaft& way)
{
    return {placement.direction_to_object(way.tip), placement.direction_to_object(way.tail)};
}

} // namespace

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
    const std::span<Row> rows = rows_of(body, contacts, parts);
    const bool stylus = probe_.kind == ProbeKind::stylus; // of the others each end by itself
    const std::array held{held_together(body, rows, stylus ? Held::anywhere : Held::at_tip),
                          stylus ? HeldTogether() : held_together(body, rows, Held::at_tail)};
    for (Row& row : rows) {
        Touched& touched = objects_[body.objects.numbers()[row.part]];
        if (row.is_first) swing_on(touched);
        feel_row(body, row);
    }
    for (const HeldTogether& end : held) push_together(end);
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
    const Placement& placement = body.placement_of(*touched.object);
    const auto tell = [&](const ObjectForce& force) {
        const double stiffness = force.felt_n_per_m,
                     pushed_m = stiffness > 0 ? std::sqrt(2 * force.surface_j / stiffness) : 0.0;
        row.felt_m = pushed_m > 0 ? pushed_m : force.felt_m;
        row.felt_dp = pushed_m > 0 ? -force.spring_n / (stiffness * pushed_m) : force.felt_dp;
        row.felt_normal = is_smooth(*touched.object->surface) ? force.normal : row.normal;
        row.felt_direction = Shaft::pushed_at(row.contact.along, row.felt_normal);
    };
    row.force = force_of(body, touched, placement, row.whole(), &row.normal_dp);
    tell(row.force);
    row.force.force_n *= row.share;
    row.force.held_j *= row.share;
    if (row.below_m >= row.contact.depth_m) return;
    Contact there = row.contact;
    there.depth_m = row.below_m;
    tell(force_of(body, touched, placement, there, &row.normal_dp));
}

std::span<Renderer::Row> Renderer::rows_of(const Body& body, std::span<const Contact> contacts,
                                           std::span<const PartContacts> parts) noexcept
{
    std::size_t count = 0;
    for (const PartContacts& part : parts) {
        Touched& touched = objects_[body.objects.numbers()[part.part]];
        std::span<const Contact> of_part = part.contacts;
        if (of_part.size() > 1 && is_smooth(*touched.object->surface)) {
            Shaft way_m; // from the hand to the proxy
            for (const Contact& contact : contacts)
                way_m += contact.depth_m * Shaft::pushed_at(contact.along, contact.normal);
            if (body.objects.joined) way_m = in_object(body.placement_of(*touched.object), way_m);
            of_part = smooth_rows_.of(*touched.object->surface, of_part, way_m, touched.lines);
        }
        for (const Contact& contact : of_part.first(std::min(of_part.size(), rows_.size() - count)))
            rows_[count++] = {.part = part.part,
                              .is_first = &contact == of_part.data(),
                              .contact = contact,
                              .below_m = contact.depth_m};
    }
    return {rows_.data(), count};
}

Renderer::HeldTogether Renderer::held_together(const Body& body, std::span<Row> rows, Held where) const noexcept
{
    HeldTogether held;
    const auto placement_of = [&](const Row& row) -> const Placement& {
        return body.placement_of(*objects_[body.objects.numbers()[row.part]].object);
    };
    for (Row& row : rows) {
        const bool elsewhere = where != Held::anywhere && (row.contact.along > 0) != (where == Held::at_tail);
        if (elsewhere || row.contact.unsettled || !(row.contact.depth_m > 0)) continue;
        row.normal = placement_of(row).direction_to_world(row.contact.normal);
        row.direction = Shaft::pushed_at(row.contact.along, row.normal);
        held.way_m += row.contact.depth_m * row.direction;
        held.row[held.count++] = &row;
    }
    if (held.count < 2 || !(length(held.way_m) > 0)) {
        held.count = 0;
        return held;
    }
    for (Row* row : held.rows()) {
        row->below_m = dot(row->direction, held.way_m);
        row->share = share_of(row->contact, row->below_m);
    }
    hold_still(held);
    for (Row* row : held.rows()) {
        glm::dvec3 moved_m(0);
        for (const Row* other : held.rows())
            if (other != row) moved_m += (other->still_m - other->contact.depth_m) * other->way_of(*row);
        row->contact.proxy_m += placement_of(*row).direction_to_object(moved_m);
    }
    return held;
}

void Renderer::Unheld::add(const Shaft& direction, double gain) noexcept
{
    const Shaft left = of(direction);
    updates_[count_++] = {left.tip, left.tail, gain / (1 + gain * dot(direction, left))};
}

Shaft Renderer::Unheld::of(const Shaft& way) const noexcept
{
    Shaft left = way;
    for (std::size_t i = 0; i < count_; ++i) {
        const auto& [tip, tail, weight] = updates_[i];
        const double part = weight * (glm::dot(tip, way.tip) + glm::dot(tail, way.tail));
        left.tip -= part * tip;
        left.tail -= part * tail;
    }
    return left;
}

// In how far each row does, and how that changes with the hand's place: by what all others leave of its direction, each
// in so far as it holds. Of what all rows leave, its own part is taken back.
void Renderer::hold_still(HeldTogether& held) noexcept
{
    const double way_m = length(held.way_m);
    const auto gain = [](double holds) { return holds / (1 - (1 - one_direction) * holds); };
    Unheld by_all;
    for (Row* row : held.rows()) {
        row->held = Rise(row->contact.depth_m / (holds_still * way_m)).value;
        by_all.add(row->direction, gain(row->held));
    }
    for (Row* row : held.rows()) {
        const Shaft rest = by_all.of(row->direction),
                    left = 1 / (1 - gain(row->held) * dot(row->direction, rest)) * rest; // by the others
        const double square = dot(row->direction, left);
        row->depth_dp = -1 / square * left;
        const double depth_m = row->contact.depth_m, q = depth_m / (holds_still * way_m);
        const Rise rise(q);
        row->still_m = depth_m * rise.value;
        row->still_dp =
            holds_still * q * q * rise.slope / way_m * held.way_m + (rise.value + q * rise.slope) * row->depth_dp;
        row->off_m = std::sqrt(square) * depth_m;
        row->off_dp = std::sqrt(square) * row->depth_dp;
    }
}

// By the places of both ends, what changes so with the place on a row: that goes with the hand, and with what the
// others hold still.
Shaft Renderer::felt_by(const Row& row, const glm::dvec3& by_place, const HeldTogether& held) noexcept
{
    Shaft felt = Shaft::pushed_at(row.contact.along, by_place);
    for (const Row* other : held.rows())
        if (other != &row) felt += glm::dot(by_place, other->way_of(row)) * other->still_dp;
    return felt;
}

// How far the proxy is below what is felt on a row, mostly less than 0, and how that changes with the hand's place, as
// the proxy stays.
void Renderer::raise(Row& row, const HeldTogether& held) noexcept
{
    glm::dvec3 left_m = held.way_m.at(row.contact.along); // from where it is felt to the proxy
    for (const Row* other : held.rows())
        if (other != &row) left_m -= other->still_m * other->way_of(row);
    row.raised_m = row.felt_m - glm::dot(row.felt_normal, left_m);
    row.raised_dp = felt_by(row, row.felt_normal + row.felt_dp - left_m * row.normal_dp, held);
}

// All places that the row leaves, of a probe that contact holds by that way.
ShaftRow Renderer::plane_of(const Row& row, const Shaft& way_m) noexcept
{
    return {row.felt_normal, dot(row.felt_direction, way_m) + row.raised_m, row.contact.along};
}

// The gradient of how far `at_m` is below that plane, as that place stays.
Shaft Renderer::below_dp(const Row& row, const Shaft& way_m, const Shaft& at_m, const HeldTogether& held) noexcept
{
    const double along = row.contact.along;
    return row.raised_dp - row.felt_direction + felt_by(row, (way_m - at_m).at(along) * row.normal_dp, held);
}

// Where the others hold the probe lower than this row is, it comes to it before contact does, and the row would begin
// with a step. So its plane is lower at first, by what it adds to the way: the root of what it adds to the square, of
// which the gradient does not step where others begin to push.
void Renderer::ease_in(const HeldTogether& held) noexcept
{
    const double tolerance_m = exact_within * length(held.way_m);
    for (Row* row : held.rows()) {
        row->eased_m = 0;
        row->eased_dp = {};
        // Of a hand that is farther on by this row's push: as where it begins.
        const Shaft way_m = held.way_m - row->contact.depth_m * row->direction;
        std::array<ShaftRow, CreaseRows::rows_most> planes;
        std::array<const Row*, CreaseRows::rows_most> of;
        std::size_t count = 0;
        for (const Row* other : held.rows())
            if (other != row) of[count++] = other;
        of[count] = row;
        for (std::size_t i = 0; i <= count; ++i) planes[i] = plane_of(*of[i], way_m);
        const auto held_by = [&](std::size_t first) {
            return project(std::span<const ShaftRow>(planes.data(), first), {}, tolerance_m);
        };
        const Projection<Shaft> others = held_by(count);
        if (dot(row->felt_direction, way_m - others.at) + row->raised_m <= tolerance_m) continue;
        const Projection<Shaft> all = held_by(count + 1);
        const double more_m = std::sqrt(std::max(0.0, dot(all.at, all.at) - dot(others.at, others.at))),
                     left = more_m > tolerance_m ? 1 - row->off_m / (eased_over * more_m) : 0;
        if (left <= 0) continue;
        Shaft more_dp; // times more_m
        const auto add = [&](const Projection<Shaft>& at, double sign) {
            for (std::size_t i = 0; i < at.count; ++i) {
                const Row& active = *of[at.active[i]];
                more_dp +=
                    sign * at.push[i] *
                    (below_dp(active, way_m, at.at, held) - dot(active.felt_direction, row->direction) * row->depth_dp);
            }
        };
        add(all, 1);
        add(others, -1);
        row->eased_m = more_m * left * left;
        row->eased_dp = (left * left + 2 * (1 - left) * left) / more_m * more_dp - 2 / eased_over * left * row->off_dp;
    }
    for (Row* row : held.rows()) {
        row->raised_m -= row->eased_m;
        row->raised_dp -= row->eased_dp;
    }
}

void Renderer::push_together(const HeldTogether& held) noexcept
{
    const double way_m = length(held.way_m);
    const auto is_facet = [&](const Row* row) {
        return std::fabs(row->raised_m) <= exact_within * way_m && length(row->raised_dp) <= exact_within &&
               row->felt_normal == row->normal;
    };
    for (Row* row : held.rows()) raise(*row, held);
    std::array<double, CreaseRows::rows_most> push_m{};
    double told = 1;
    Shaft at_m = held.way_m;
    if (std::ranges::all_of(held.rows(), is_facet)) {
        for (std::size_t i = 0; i < held.count; ++i) push_m[i] = held.row[i]->contact.depth_m;
    } else {
        ease_in(held);
        std::array<ShaftRow, CreaseRows::rows_most> planes;
        for (std::size_t i = 0; i < held.count; ++i) planes[i] = plane_of(*held.row[i], held.way_m);
        const Projection<Shaft> at =
            project(std::span<const ShaftRow>(planes.data(), held.count), {}, exact_within * way_m);
        double pushes_m = 0;
        for (std::size_t i = 0; i < at.count; ++i) pushes_m += push_m[at.active[i]] = at.push[i];
        told = std::min(1.0, opposed_most * length(at.at) / pushes_m);
        at_m = at.at;
    }
    for (std::size_t i = 0; i < held.count; ++i) {
        Row& row = *held.row[i];
        const double along = row.contact.along;
        ObjectForce& force = row.force;
        const Shaft more_n = -told * (force.felt_n_per_m * push_m[i] * below_dp(row, held.way_m, at_m, held) +
                                      Shaft::pushed_at(along, row.share * force.spring_n));
        row.at_ends_n = more_n;
        const glm::dvec3 here_n = row.contact.by_shaft ? more_n.tip + more_n.tail
                                  : along > 0          ? more_n.tail
                                                       : more_n.tip;
        const double along_n = glm::dot(force.force_n + here_n, force.normal);
        if (along_n < 0) force.force_n -= std::max(along_n, -glm::length(here_n)) * force.normal; // never pulls
    }
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
