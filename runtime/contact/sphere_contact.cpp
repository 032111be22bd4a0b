#include "runtime/contact/sphere_contact.h"

#include "runtime/geometry/finite.h"
#include "runtime/geometry/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace haptel::runtime {

namespace {

// A ball smaller than this is a point that rounding can move through a face.
constexpr double least_radius = 0x1p20;

// Of the radius: how far around is looked at once at least, and when anew; and what is left of a way counts as none.
constexpr double margin_most = 1.0 / 16, margin_least = 1.0 / 64, centre_settled = 1e-8;

// Where there are fewer faces the ball looks farther around, where there are more less far.
constexpr std::size_t few_faces = 16, many_faces = 64;

// It looks farther around than margin_most only for so many faces. Where there are too many it looks less far by this,
// so often below margin_most.
constexpr std::size_t far_faces = 256;
constexpr double less_far = 1.0 / 8;
constexpr int looks_most = 4;

// Looked at in one tick before the rest of the way is left to the next: it bounds the time of a tick.
constexpr uint64_t faces_per_tick = 1 << 11;

// How far a round may lead is what planes are picked for: of the hand's way, of the last step, of a last step that came
// to the end of what was picked; of the radius at least; and picked anew where it is so many times as far as needed.
constexpr double stride_of_hand = 1.1, stride_of_step = 0.5, stride_of_end = 4, stride_least = 1e-3, stride_most = 8;

// A ball that moves out looks so many times as far as it lacks, for grooves hold it farther out than their walls are
// near, grows at once by no more than this of what it has looked at, and tries so many ways, each half as long as one
// that was not free. Once it has looked at so many faces it stays where it has come to.
constexpr double out_most = 4, out_of_room = 0.9;
constexpr int ways_out_most = 32;
constexpr uint64_t faces_out_most = 1 << 15;

} // namespace

SphereContact::SphereContact(std::shared_ptr<const Surface> surface, double radius_m)
    : surface_(std::move(surface)), radius_(radius_m / surface_->lattice.unit_m), grown_(radius_), faces_(*surface_)
{
}

void SphereContact::reset() noexcept
{
    placed_ = sliding_ = false;
    around_ = close_ = {};
    lag_ = 0;
    contact_count_ = 0;
    counters_ = {};
}

std::span<const Contact> SphereContact::update(const glm::dvec3& centre_m, const Friction& friction) noexcept
{
    ++counters_.ticks;
    if (!finite(centre_m)) {
        ++counters_.hands_held;
        for (Contact& contact : contacts_) contact.hand_held = true;
        return {contacts_, contact_count_};
    }
    hand_before_ = hand_;
    hand_ = surface_->lattice.snap(centre_m);
    if (!placed_) place();
    if (placed_) move(friction);
    counters_.touching_ticks += contact_count_ > 0;
    return {contacts_, contact_count_};
}

void SphereContact::follow(const glm::dvec3& centre_m) noexcept
{
    ++counters_.ticks;
    ++counters_.skipped;
    if (!finite(centre_m)) return;
    centre_ = hand_ = surface_->lattice.snap(centre_m);
    placed_ = true; // as large as it is, where there is nothing
}

double SphereContact::gap_m(const glm::dvec3& centre_m) const noexcept
{
    return std::max(0.0, surface_->gap_to_box_m(centre_m, centre_m) - radius_ * surface_->lattice.unit_m);
}

// As large as fits where the hand is.
void SphereContact::place() noexcept
{
    centre_ = hand_;
    if (!look_around(0)) {
        ++counters_.walks_cut;
        return;
    }
    grown_ = faces_.distance(centre_, radius_);
    placed_ = grown_ >= std::min(least_radius, radius_);
}

// The ball as it is keeps in front of the planes all along a straight way out of those of the larger ball: it meets
// nothing that it has not looked at.
bool SphereContact::move_out(double most_m) noexcept
{
    if (!placed_ || grown_ >= radius_ || (radius_ - grown_) * surface_->lattice.unit_m > most_m) return false;
    const double before = grown_;
    const uint64_t seen = counters_.triangles_tested;
    double share = 1;
    bool looked = false; // from here
    for (int tries = 0; tries < ways_out_most && radius_ - grown_ > centre_settled * radius_; ++tries) {
        const double lacks = radius_ - grown_;
        if (!looked && around_.room(centre_) < 0.5 * lacks) {
            if (counters_.triangles_tested - seen > faces_out_most || !look_around(out_most * lacks)) break;
            looked = true;
        }
        const double room = around_.room(centre_), more = share * std::min(lacks, out_of_room * room);
        faces_.pick(centre_, grown_ + more + 2 * distance_rounding, room);
        const glm::dvec3 out = nearest_in(faces_.picked(), centre_, centre_, distance_rounding).at;
        bool free = glm::distance(centre_, out) <= room;
        for (const HalfSpace& space : faces_.picked())
            free = free && glm::dot(space.normal, out) - space.offset >= -2 * distance_rounding;
        share = free ? std::min(1.0, 2 * share) : 0.5 * share;
        if (!free) continue;
        centre_ = out;
        looked = false;
        grown_ = std::max(grown_, faces_.distance(centre_, radius_ + distance_rounding) - distance_rounding);
    }
    around_ = close_ = {};
    margin_ = 0;
    return grown_ > before;
}

// Finds the faces within the radius and a margin, or within less where there are too many. False: nothing less is left.
bool SphereContact::look_around(double margin) noexcept
{
    close_.margin = -1;
    const double near = margin_most * radius_;
    for (int looks = 0; looks < looks_most;) {
        const bool far = margin > near;
        const bool all =
            faces_.find(centre_, radius_ + margin + distance_rounding, far ? far_faces : NearFaces::faces_most);
        ++counters_.sweeps;
        counters_.triangles_tested += faces_.boxes();
        if (all) {
            around_ = {centre_, margin};
            if (faces_.count() < few_faces) margin_ = std::min(2 * std::max(margin, margin_), Lattice::extent);
            if (faces_.count() > many_faces) margin_ = 0.5 * margin;
            return true;
        }
        margin = far ? std::max(near, less_far * margin) : less_far * margin;
        margin_ = margin;
        looks += !far;
    }
    around_.margin = -1;
    return false;
}

// One straight step toward the hand, or to where the planes around let it come. Those that hold it are seen from here.
NearestInHalfSpaces SphereContact::approach(double step_max) noexcept
{
    const glm::dvec3 to_hand = hand_ - centre_;
    if (path_length_ == 0) { // in the air: first straight on, to where it touches
        const double length = glm::length(to_hand);
        const double within = length > step_max ? step_max / length : 1;
        OpenShare open;
        do open = open_share(faces_.picked(), centre_, within * to_hand, 0);
        while (open.share < 1 && faces_.renew(open.ended_by, centre_));
        centre_ += open.share * within * to_hand;
        if (open.share == 1) return {centre_, 0, {}, {}};
        path_[path_length_++] = centre_;
        step_max -= open.share * within * length;
    }
    NearestInHalfSpaces found;
    for (bool renewed = true; renewed;) {
        found = nearest_in(faces_.picked(), hand_, centre_, distance_rounding);
        renewed = false;
        for (std::size_t i = 0; i < found.count; ++i) renewed |= faces_.renew(found.active[i], centre_);
    }
    const glm::dvec3 way = found.at - centre_;
    const double length = glm::length(way);
    centre_ += length > step_max ? step_max / length * way : way;
    return found;
}

// Toward the hand, as near as it can slide, or to where it touches.
SphereContact::Way SphereContact::go(bool until_it_touches) noexcept
{
    path_length_ = 0;
    if (contact_count_ > 0) path_[path_length_++] = centre_;
    Way done;
    auto& [found, round, cut, on_the_way, blind] = done;
    double stride = stride_of_hand * glm::distance(hand_, hand_before_) + lag_;
    const uint64_t seen = counters_.triangles_tested;
    for (;; ++round) {
        const double want = glm::distance(hand_, centre_);
        if (want == 0) break;
        cut = round == rounds_max;
        if (cut) break;
        if (around_.room(centre_) < std::min(want, margin_least * radius_)) {
            if (round > 0 && counters_.triangles_tested - seen > faces_per_tick) {
                cut = on_the_way = true;
                break;
            }
            const double most = std::max(margin_, margin_most * radius_);
            if (!look_around(std::clamp(2 * want, margin_least * radius_, most))) {
                blind = true;
                return done;
            }
        }
        const double open = std::min(want, around_.room(centre_));
        stride = std::max(stride, stride_least * radius_);
        if (round == 0 || close_.room(centre_) < std::min(open, stride) || close_.margin > stride_most * stride) {
            close_ = {centre_, path_length_ == 0 ? open : std::min(open, stride)};
            faces_.pick(centre_, grown_, close_.margin);
        }
        const glm::dvec3 before = centre_;
        const double step_max = std::min(open, close_.room(centre_));
        found = approach(step_max);
        if (until_it_touches && path_length_ > 0) break;
        if (found.count == 0) path_length_ = 0;
        if (path_length_ > 0 && path_length_ <= rounds_max) path_[path_length_++] = centre_;
        const double step = glm::distance(before, centre_);
        if (step <= std::max(4 * distance_rounding, centre_settled * radius_)) break;
        on_the_way = step > 0.5 * open;
        stride = (step > 0.9 * step_max ? stride_of_end : stride_of_step) * step;
    }
    return done;
}

void SphereContact::move(const Friction& friction) noexcept
{
    const bool in_air = contact_count_ == 0;
    sliding_ = sliding_ && !in_air &&
               slides_on(contacts(), surface_->lattice.metres(hand_) - contacts_[0].hand_m, checked(friction));
    const glm::dvec3 start = centre_;
    Way way = go(in_air);
    // How far it had looked around before decides how its way is cut into steps, and friction feels them: where it
    // comes to touch it goes there once more, knowing nothing. Whoever comes the same way then feels the same.
    if (in_air && !way.blind && (way.cut || path_length_ > 0)) {
        centre_ = start;
        around_ = close_ = {};
        margin_ = 0;
        way = go(false);
    }
    if (way.blind) {
        ++counters_.walks_cut; // too much at once: what is touched stays touched
        return;
    }
    const auto& [found, round, cut, on_the_way, blind] = way;
    if (in_air && found.count == 0 && glm::distance(centre_, hand_) <= distance_rounding) centre_ = hand_;
    counters_.walk_steps += round;
    counters_.walk_steps_max = std::max<uint64_t>(counters_.walk_steps_max, round);
    counters_.walks_cut += cut;
    counters_.skipped += round == 0;
    if (grown_ < radius_) grown_ = std::max(grown_, faces_.distance(centre_, radius_) - distance_rounding);
    // The planes here do not know how deep the hand is where it is: until the ball is there what was felt is felt, but
    // of what the hand has left.
    if (cut && on_the_way) {
        if (contact_count_ > 0 && glm::dot(hand_ - centre_, contacts_[0].normal) >= 0) contact_count_ = 0;
        push_no_harder_than(glm::distance(centre_, hand_) * surface_->lattice.unit_m);
        return;
    }
    if (found.count == 0) {
        sliding_ = false;
        lag_ = 0;
        contact_count_ = 0;
        return;
    }
    const glm::dvec3 nearest = centre_;
    hold_by_friction(found, friction);
    describe(found, nearest);
    lag_ = glm::distance(centre_, nearest);
    const glm::dvec3 lag_m = (centre_ - nearest) * surface_->lattice.unit_m;
    double depth_m = 0;
    for (std::size_t i = 0; i < contact_count_; ++i) depth_m += contacts_[i].depth_m;
    for (std::size_t i = 0; i < contact_count_; ++i)
        contacts_[i].lag_m = depth_m > 0 ? contacts_[i].depth_m / depth_m * lag_m : glm::dvec3(0);
}

// What was felt where the hand has been is no more than its spring pulls now.
void SphereContact::push_no_harder_than(double way_m) noexcept
{
    glm::dvec3 told_m(0);
    for (std::size_t i = 0; i < contact_count_; ++i)
        told_m += contacts_[i].depth_m * contacts_[i].normal + contacts_[i].lag_m;
    const double told = glm::length(told_m);
    for (std::size_t i = 0; i < contact_count_ && told > way_m; ++i) {
        contacts_[i].depth_m *= way_m / told;
        contacts_[i].lag_m *= way_m / told;
    }
}

// Friction is a way that ends early, where what is left of it is the coefficient times what presses, or does not begin.
void SphereContact::hold_by_friction(const NearestInHalfSpaces& found, const Friction& friction) noexcept
{
    const auto [rest, slide] = checked(friction);
    const glm::dvec3 nearest = centre_;
    const double depth = glm::distance(nearest, hand_);
    if (depth == 0) return;
    const glm::dvec3 normal = (nearest - hand_) / depth;
    const double pushes = std::accumulate(found.push.begin(), found.push.begin() + std::ptrdiff_t(found.count), 0.0);
    const double pressed = pushes / depth; // in a groove by both its walls
    struct Held {
        glm::dvec3 across; // at a right angle to the push
        double up;         // along it
        double limit;      // of `across`, by a coefficient of 1
    };
    const auto held_at = [&](const glm::dvec3& place) {
        const glm::dvec3 lag = place - nearest;
        const double up = glm::dot(lag, normal);
        return Held{lag - up * normal, up, pressed * std::max(0.0, depth + up)};
    };
    // Nor is a way that leads down held higher than the end of it bears.
    const auto holds = [&](const Held& held, double coefficient) {
        const double most = coefficient * held.limit;
        return glm::dot(held.across, held.across) <= most * most && held.up <= coefficient * pushes;
    };
    const Held first = held_at(path_[0]);
    if (rest > 0 && holds(first, sliding_ ? slide : rest)) {
        centre_ = path_[0];
        return;
    }
    sliding_ = sliding_ || glm::length(first.across) - slide * first.limit > distance_rounding;
    uint32_t end = path_length_ - 1;
    while (end > 0 && holds(held_at(path_[end - 1]), slide)) --end;
    if (end == 0) return;
    // Where along this piece, beginning at its end, the two are equal: a quadratic equation.
    const Held at_end = held_at(path_[end]), at_begin = held_at(path_[end - 1]);
    const glm::dvec3 across = at_begin.across - at_end.across;
    const double limit = slide * at_end.limit, more = slide * at_begin.limit - limit;
    const double a = glm::dot(across, across) - more * more, b = glm::dot(at_end.across, across) - limit * more;
    const double c = std::min(0.0, glm::dot(at_end.across, at_end.across) - limit * limit);
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    double share = std::min(1.0, b > 0 ? -c / (b + root) : a > 0 ? (root - b) / a : 1.0);
    if (at_begin.up > slide * pushes && at_begin.up > at_end.up)
        share = std::min(share, std::max(0.0, slide * pushes - at_end.up) / (at_begin.up - at_end.up));
    centre_ = path_[end] + share * (path_[end - 1] - path_[end]);
}

// Of the faces that meet where the ball touches one the one that turns to it most: another may be the bottom of an
// object that lies on the other's top, and ends in the same edge where nobody can come to it.
uint32_t SphereContact::outermost(uint32_t face, const glm::dvec3& normal, const glm::dvec3& centre) const noexcept
{
    constexpr double same_place = 64; // lattice units
    const auto nearest = [&](uint32_t number) {
        const auto& vertex = surface_->faces[number].vertex;
        return nearest_point(surface_->vertices[vertex[0]], surface_->vertices[vertex[1]],
                             surface_->vertices[vertex[2]], centre)
            .at;
    };
    const auto turned = [&](uint32_t number) { return std::fabs(glm::dot(surface_->faces[number].normal, normal)); };
    const glm::dvec3 at = nearest(face);
    for (std::size_t i = 0; i < faces_.picked().size(); ++i) {
        const uint32_t other = faces_.face(static_cast<uint32_t>(i));
        if (turned(other) > (1 + 1e-9) * turned(face) && glm::distance(nearest(other), at) < same_place) face = other;
    }
    return face;
}

void SphereContact::describe(const NearestInHalfSpaces& found, const glm::dvec3& nearest) noexcept
{
    std::array<uint32_t, 3> order{0, 1, 2}; // who presses most first
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {0, 1}})
        if (b < static_cast<int>(found.count) && found.push[order[b]] > found.push[order[a]])
            std::swap(order[a], order[b]);
    contact_count_ = found.count;
    for (std::size_t i = 0; i < found.count; ++i) {
        const uint32_t picked = found.active[order[i]];
        Contact& contact = contacts_[i];
        contact = {};
        contact.touching = true;
        contact.sliding = sliding_;
        contact.face = faces_.face(picked);
        if (!surface_->origins.empty()) contact.face = outermost(contact.face, faces_.picked()[picked].normal, nearest);
        const Face& face = surface_->faces[contact.face];
        contact.normal = faces_.picked()[picked].normal;
        contact.side = glm::dot(contact.normal, face.normal) >= 0 ? 0 : 1;
        contact.facet_normal = surface_->facet_normal(contact.face, contact.side);
        const NearestPoint point = nearest_point(surface_->vertices[face.vertex[0]], surface_->vertices[face.vertex[1]],
                                                 surface_->vertices[face.vertex[2]], nearest);
        contact.barycentric = point.barycentric;
        contact.proxy_m = surface_->lattice.metres(point.at);
        contact.hand_m = surface_->lattice.metres(hand_);
        contact.depth_m = contact.pressed_m = found.push[order[i]] * surface_->lattice.unit_m;
    }
}

} // namespace haptel::runtime
