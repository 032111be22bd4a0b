// A tick of the stylus: from the pose to contacts. What holds it is in stylus_hold.cpp, how the shaft moves in
// stylus_shaft.cpp.
#include "runtime/contact/stylus_contact.h"

#include "runtime/geometry/finite.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace haptel::runtime {

using namespace shaft_tolerance;

namespace {

// Of a stylus that reaches beyond the workspace what is farther out than this is left out: there is nothing, and the
// ideal stylus is not quite where the hand's is.
constexpr double drawn_in = 0.75 * Lattice::workspace;

// Lattice units. A shaft shorter than this has no direction.
constexpr double least_length = 4096;

// Lattice units, and share of what the springs are drawn by: what is not known and pushes less is not told.
constexpr double least_push = 4096, least_push_share = 1e-6;

} // namespace

StylusContact::StylusContact(std::shared_ptr<const Surface> surface, double rate_hz)
    : tip_(std::make_unique<SphereContact>(surface))
    , tail_(std::make_unique<SphereContact>(surface))
    , patience_ticks_(static_cast<uint32_t>(std::max(1.0, std::round(patience_s * rate_hz))))
{
}

void StylusContact::reset() noexcept
{
    tip_->reset();
    tail_->reset();
    has_shaft_ = tracked_ = false;
    side_count_ = contact_count_ = 0;
    clear_ = {};
    reached_ = {};
    stuck_ticks_ = 0;
    counters_ = {};
}

std::optional<Shaft> StylusContact::ideal() const noexcept
{
    return tracked_ ? std::optional(shaft_) : std::nullopt;
}

const Contact& StylusContact::update(const glm::dvec3& tip_m, const glm::dvec3& tail_m,
                                     const EndsFriction& friction) noexcept
{
    if (!finite(tip_m)) { // what touches goes on touching
        tip_->tick(tip_m, friction.tip);
        return tip_->contact();
    }
    clear_.unspared = -1;
    left_ = {};
    const bool had_tip = begin_ == 0, had_tail = end_ == 1;
    has_shaft_ = take(tip_m, tail_m);
    tracked_ = tracked_ && has_shaft_;
    if (!tracked_) {
        const uint64_t cut = tip_->counters().walks_cut;
        has_shaft_ ? start(tip_m, friction.tip) : tip_->tick(tip_m, friction.tip);
        counters_.walks_cut += tip_->counters().walks_cut - cut;
    } else if (!pass_freely(tip_m, tail_m)) {
        if (!had_tip || begin_ > 0) tip_->restart(begin_ > 0 ? Lattice::snap_units(hand_.tip) : shaft_.tip);
        if (!had_tail || end_ < 1) tail_->restart(end_ < 1 ? Lattice::snap_units(hand_.tail) : shaft_.tail);
        resolve(friction);
    }
    report();
    return tip_->contact();
}

void StylusContact::follow(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    tip_->follow(tip_m);
    tracked_ = has_shaft_ = take(tip_m, tail_m);
    side_count_ = 0;
    clear_.radius = 0; // it may be out of it
    if (tracked_) {
        reached_ = hand_;
        shaft_ = within(hand_.tip, hand_.tail);
        tail_->follow(tail_m);
    }
    contact_count_ = 0;
}

// Takes the pose; false if there is no shaft in the workspace.
bool StylusContact::take(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    const Lattice& lattice = surface().lattice;
    const Shaft hand{lattice.units(tip_m), lattice.units(tail_m)};
    if (!std::isfinite(glm::length(hand.tail - hand.tip))) return false; // it has no direction
    hand_ = hand;
    if (tip_->proxy().touches()) hand_.tip = Lattice::snap_units(hand_.tip); // it does not let go of a hand that is far
    const glm::dvec3 along = hand_.tail - hand_.tip;
    const bool tip_is_in = !Lattice::beyond_workspace(hand_.tip), tail_is_in = !Lattice::beyond_workspace(hand_.tail);
    begin_ = 0, end_ = 1;
    if (!(tip_is_in && tail_is_in) && !Lattice::clip_to_cube(hand_.tip, along, glm::dvec3(0), drawn_in, begin_, end_))
        return false;
    if (tip_is_in) begin_ = 0, hand_.tip = glm::round(hand_.tip); // as the hand of a point is
    if (tail_is_in) end_ = 1, hand_.tail = glm::round(hand_.tail);
    return (end_ - begin_) * glm::length(along) > least_length; // false for what is not finite, too
}

// The part of a stylus that is in the workspace.
Shaft StylusContact::within(const glm::dvec3& tip, const glm::dvec3& tail) const noexcept
{
    const auto at = [&](double share) {
        return Lattice::snap_units(share == 0 ? tip : share == 1 ? tail : tip + share * (tail - tip));
    };
    return {at(begin_), at(end_)};
}

// The whole stylus of which a part is in the workspace.
Shaft StylusContact::extended(const Shaft& part) const noexcept
{
    const double share = end_ - begin_;
    return {begin_ == 0 ? part.tip : part.at(-begin_ / share), end_ == 1 ? part.tail : part.at((1 - begin_) / share)};
}

// A stylus that is put down, or that could not be held yet.
void StylusContact::start(const glm::dvec3& tip_m, const Friction& friction) noexcept
{
    const Shaft whole = within(hand_.tip, hand_.tail);
    Crossing crossing;
    clear_.radius = 0;
    const bool first = !tip_->is_placed();
    const bool crosses =
        first && first_crossing(surface(), whole.tail, whole.tip, StartsOn::nothing(), crossing, counters_);
    tip_->tick(tip_m, friction, crosses ? &whole.tail : nullptr);
    tail_->restart(whole.tail);
    reached_ = hand_;
    side_count_ = 0;
    stuck_ticks_ = 0;
    shaft_ = within(tip_->proxy().touches() ? tip_->proxy().at : hand_.tip, hand_.tail);
    if (begin_ == 0) shaft_.tip = glm::round(tip_->proxy().at);
    tracked_ = (first && !crosses) ||
               !first_crossing(surface(), shaft_.tip, shaft_.tail, StartsOn::nothing(), crossing, counters_);
}

// Where nothing is near nothing is touched: to the hand, if so.
bool StylusContact::pass_freely(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    if (side_count_ > 0 || tip_->proxy().touches() || tail_->proxy().touches()) return false;
    const Shaft to = within(hand_.tip, hand_.tail);
    if (!clear_.spares(farther(clear_.at, to))) {
        ++counters_.sweeps;
        if (!swept_to(to).is_empty(*surface().tree)) return false;
        clear_.unspared = farther(shaft_, to);
    }
    shaft_ = to;
    reached_ = hand_;
    tip_->follow(tip_m);
    tail_->follow(tail_m);
    return true;
}

void StylusContact::look_around() noexcept
{
    clear_.look(shaft_, [&](double radius) {
        const SweptRegion around(shaft_.tip, shaft_.tail, shaft_.tip, shaft_.tail, radius);
        return around.is_empty(*surface().tree) ? radius : 0.0;
    });
}

void StylusContact::report() noexcept
{
    contact_count_ = 0;
    for (const Contact& contact : tip_->contacts()) contacts_[contact_count_++] = contact;
    if (!tracked_) return;

    const uint32_t first = contact_count_;
    for (uint32_t i = 0; i < side_count_; ++i) {
        const Side& side = sides_[i];
        if (!(side.push > 0)) continue;
        const SideEdge other = surface().faces[side.face].link[side.edge][0];
        const auto facing = [&](uint32_t face) {
            return std::fabs(glm::dot(side.normal, surface().facet_normal(face)));
        };
        const uint32_t face = facing(other.face()) > facing(side.face) ? other.face() : side.face;
        tell(glm::clamp(side.share, 0.0, 1.0), face, side.point, side.normal, side.push);
    }
    std::ranges::sort(std::span(contacts_).first(contact_count_).subspan(first), std::greater(), &Contact::depth_m);
    if (end_ == 1)
        for (const Contact& contact : tail_->contacts()) {
            contacts_[contact_count_] = contact;
            contacts_[contact_count_++].along = 1;
        }
    tell_what_is_left();
}

// One more contact of the shaft, by a push in lattice units.
void StylusContact::tell(double along, uint32_t face, const glm::dvec3& point, const glm::dvec3& normal,
                         double push) noexcept
{
    const Lattice& lattice = surface().lattice;
    Contact contact;
    contact.touching = contact.by_shaft = true;
    contact.along = along;
    contact.face = face;
    contact.side = glm::dot(normal, surface().facet_normal(face)) >= 0 ? 0 : 1;
    contact.proxy_m = lattice.metres(point);
    contact.hand_m = lattice.metres(hand_.at(along));
    contact.barycentric = barycentric_of(surface(), face, point);
    contact.facet_normal = surface().facet_normal(face, contact.side);
    contact.normal = normal;
    contact.depth_m = push * lattice.unit_m;
    contacts_[contact_count_++] = contact;
}

// What the springs of the ends are drawn by, and none of the contacts known by now makes up for: where ends and shaft
// have not come to agree it is held by what it does not know yet. So the force is that of the potential in every tick.
void StylusContact::tell_what_is_left() noexcept
{
    if (left_ == Shaft()) return;
    const Shaft ideal = extended(shaft_);
    const glm::dvec3 &tip = left_.tip, &tail = left_.tail;
    const double least = std::max(least_push / (end_ - begin_), least_push_share * away(shaft_));
    const double tip_push = glm::length(tip), tail_push = glm::length(tail);
    const uint32_t told = contact_count_;
    if (tip_push > least) tell(0, nearest_face(*tip_, 0), ideal.tip, tip / tip_push, tip_push);
    if (tail_push > least) tell(1, nearest_face(*tail_, 1), ideal.tail, tail / tail_push, tail_push);
    for (uint32_t i = told; i < contact_count_; ++i) contacts_[i].unsettled = true;
}

// Of those that are known: it has the material of its object.
uint32_t StylusContact::nearest_face(const SphereContact& end, double along) const noexcept
{
    if (end.contact().touching) return end.contact().face;
    const Side* nearest = nullptr;
    for (const Side& side : std::span(sides_.data(), side_count_))
        if (!nearest || std::fabs(side.share - along) < std::fabs(nearest->share - along)) nearest = &side;
    return nearest ? nearest->face : met_.face;
}

ContactCounters StylusContact::counters() const noexcept
{
    ContactCounters all = tip_->counters() + tail_->counters() + counters_;
    all.walks_cut = counters_.walks_cut; // where an end alone finds no rest, both look for it together
    return all;
}

double StylusContact::gap_m(const glm::dvec3& tip_m, const glm::dvec3& tail_m) const noexcept
{
    const bool at_hand = tracked_ ? shaft_ == within(hand_.tip, hand_.tail) : !has_shaft_;
    return at_hand ? surface().gap_to_box_m(tip_m, tail_m) : 0;
}

} // namespace haptel::runtime
