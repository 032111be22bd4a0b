// How the shaft of a stylus moves: straight past edges, and what it meets on the way.
#include "runtime/contact/stylus_contact.h"
#include "runtime/geometry/predicates.h"
#include "runtime/surface/collision.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

using namespace shaft_tolerance;

namespace {

// What is nearer to the shaft than this is seen: what it rests on is not.
constexpr double near_enough = rest_gap * (1 - 1e-3);

// A contact that slides off its edge does so by this many units and this share of its way, so that it is not found
// there again, wherever the way bends.
constexpr double beyond = 0.25 * rest_gap, past_the_end = 0.05;

// Of what is known around its ends a shaft that rests on edges goes so far at once: it is raised there.
constexpr double on_reach = 0.9;

} // namespace

const glm::dvec3& StylusContact::edge_end(uint32_t face, uint32_t edge, uint32_t which) const noexcept
{
    return surface().vertex(face, which ? next(edge) : edge);
}

Passing StylusContact::passing_of(const Side& side, const Shaft& shaft) const noexcept
{
    return passing(shaft, edge_end(side.face, side.edge, 0), edge_end(side.face, side.edge, 1));
}

// The share of the straight way there on which nothing is that the ends may meet: what is known around them, and
// farther than that, up to `stride`, as far as they cross nothing.
double StylusContact::known_share(const Shaft& to, double stride, const Projection<Shaft>& held,
                                  const FrictionOfEnds& ends) noexcept
{
    double share = 1;
    const double most = side_count_ > 0 ? on_reach : 1;
    const auto reaches = [&](const SphereContact& end, const EndRows& rows, const glm::dvec3& from,
                             const glm::dvec3& there, bool drags) {
        const glm::dvec3 way = there - from;
        const double length = glm::length(way), reach = most * rows.reach;
        const bool lands = drags && rows.count == 0; // friction holds it from where it comes to touch
        Crossing crossing;
        if (length > reach || (lands && !end.planes().empty())) {
            const double farthest = std::min(1.0, std::max(reach, most * stride) / length);
            share = std::min(share, farthest);
            if ((lands || farthest * length > reach) &&
                first_crossing(surface(), from, glm::round(from + farthest * way), StartsOn::nothing(), crossing,
                               counters_))
                share = std::min(share, std::max(lands ? 0.0 : reach / length,
                                                 farthest * crossing.fraction() - 2 * rest_gap / length));
        }
        if (!lands) // the rows hold it off them, but for those that friction left out, or that contradict others
            share = std::min(share, open_share(end.planes(), from, way, distance_rounding));
    };
    if (begin_ == 0) reaches(*tip_, tip_rows_, shaft_.tip, to.tip, ends.tip.friction.static_coefficient > 0);
    if (end_ == 1) reaches(*tail_, tail_rows_, shaft_.tail, to.tail, ends.tail.friction.static_coefficient > 0);
    for (std::size_t k = 0; k < held.count; ++k) {
        if (held.active[k] < row_count_) continue;
        const Side& side = sides_[held.active[k] - row_count_];
        const Passing now = passing_of(side, shaft_), then = passing_of(side, to);
        if (now.parallel || then.parallel) continue;
        const auto stay = [&](double from, double there, double low, double high) {
            const double over = past_the_end * std::fabs(there - from);
            low -= over, high += over;
            const double end = there < low ? low : there > high ? high : there;
            if (end != there && from > low && from < high) share = std::min(share, (end - from) / (there - from));
        };
        const double off = let_go + beyond, off_shaft = (let_go_by_end + beyond) / now.shaft_length;
        stay(now.on_edge, then.on_edge, -off, now.edge_length + off);
        stay(now.on_shaft, then.on_shaft, -off_shaft, 1 + off_shaft);
    }
    return share;
}

// Straight to there. False: it met something on its way, which now is a contact, or the way is too long.
bool StylusContact::move(const Shaft& to) noexcept
{
    met_ = {};
    const SweptRegion swept = swept_to(to);
    if (!find_near(swept)) return false;
    if (!blocked(to, swept, met_)) {
        shaft_ = to;
        touch(close_);
        return true;
    }
    approach(to, met_);
    touch(met_);
    return false;
}

// While the shaft rests on nothing its ends are two points. False: it would meet something, or they find no rest.
bool StylusContact::go_apart(const EndsFriction& friction) noexcept
{
    if (side_count_ > 0 || begin_ > 0 || end_ < 1) return false;
    const Shaft from = shaft_;
    const auto gives_up = [&] {
        shaft_ = from;
        tip_->come_back(from.tip);
        tail_->come_back(from.tail);
        return false;
    };
    const bool tail_rests = tail_->go(hand_.tail, friction.tail), tip_rests = tip_->go(hand_.tip, friction.tip);
    if (!tail_rests || !tip_rests) return gives_up();
    const Shaft to{tip_->proxy().at, tail_->proxy().at};
    const auto goes = [&](const Shaft& there) {
        if (there != shaft_)
            if (const SweptRegion swept = swept_to(there);
                !find_near(swept) || blocked(there, swept, met_) || close_.side != 0)
                return false;
        shaft_ = there;
        return true;
    };
    // Both ends at once may go through one triangle: the straight way of one of them has to be free.
    const std::span<const glm::dvec3> places = tip_->places();
    const bool is_straight = std::all_of(places.begin(), places.end(), [&](const glm::dvec3& place) {
        return place == from.tip || glm::round(place) == to.tip;
    });
    Crossing crossing;
    const bool is_free =
        is_straight || !first_crossing(surface(), from.tip, to.tip, StartsOn::nothing(), crossing, counters_);
    if (!(is_free && goes(to))) { // on it the tip would get below an edge: along the way that it has gone
        const double way = glm::distance(to.tip, from.tip);
        if (way == 0) return gives_up();
        for (const glm::dvec3& place : places) {
            const double share = std::min(1.0, glm::distance(to.tip, place) / way);
            const Shaft part{glm::round(place), glm::round(to.tail + share * (from.tail - to.tail))};
            if (sweeps_left_ < 3 * sweeps_max / 4 || !goes(part)) return gives_up();
        }
        if (!goes(to)) return gives_up();
    }
    reached_ = hand_;
    stuck_ticks_ = 0;
    return true;
}

bool StylusContact::is_side(const glm::dvec3& edge0, const glm::dvec3& edge1) const noexcept
{
    return std::any_of(sides_.begin(), sides_.begin() + side_count_, [&](const Side& side) {
        const glm::dvec3 &c = edge_end(side.face, side.edge, 0), &d = edge_end(side.face, side.edge, 1);
        return (edge0 == c && edge1 == d) || (edge0 == d && edge1 == c);
    });
}

// What the shaft comes near to at the end of its move becomes a contact.
void StylusContact::see(uint32_t face, uint32_t edge, const Shaft& to) noexcept
{
    const glm::dvec3 &a = edge_end(face, edge, 0), &b = edge_end(face, edge, 1);
    const Passing lines = passing(to, a, b);
    if (lines.parallel) return;
    const int sign = -side_of_line(glm::round(to.tip), glm::round(to.tail), a, b);
    if (!lines.within(0, rest_gap)) return;
    const double beyond = std::max({0.0, -lines.on_edge, lines.on_edge - lines.edge_length});
    const double height = std::hypot(lines.height, beyond);
    if (!(height < close_.height)) return;
    if (is_side(a, b)) return;
    close_ = {face, edge, 1, sign, false, height};
}

// Whether an edge cannot be met by a shaft that goes to a place above one of its sides: the side's own edge, and what
// lies below it beside it. Where the shaft turns about a side the straight ways of its ends lead a little below, and
// where it slides over the end of one it would get caught between that and the next.
bool StylusContact::is_below_a_side(uint32_t vertex0, uint32_t vertex1, const Shaft& to) const noexcept
{
    const Surface& s = surface();
    for (uint32_t i = 0; i < side_count_; ++i) {
        const auto& corners = s.faces[sides_[i].face].vertex;
        const uint32_t a = corners[sides_[i].edge], b = corners[next(sides_[i].edge)];
        const bool shares0 = vertex0 == a || vertex0 == b, shares1 = vertex1 == a || vertex1 == b;
        if (!shares0 && !shares1) continue;
        const Passing there = passing_of(sides_[i], to);
        if (there.parallel || sides_[i].sign * there.height <= 0) continue;
        if (shares0 && shares1) return true;
        const glm::dvec3 away = s.vertices[shares0 ? vertex1 : vertex0] - s.vertices[shares0 ? vertex0 : vertex1];
        if (sides_[i].sign * glm::dot(there.normal, away) < rest_gap) return true;
    }
    return false;
}

SweptRegion StylusContact::swept_to(const Shaft& to) const noexcept
{
    return {shaft_.tip, shaft_.tail, to.tip, to.tail, rest_gap + reach};
}

// What may be met on a straight way from where it is. False: more than may be looked at on one way.
bool StylusContact::find_near(const SweptRegion& swept) noexcept
{
    const Surface& s = surface();
    near_count_ = 0;
    const bool all = s.tree->for_each(swept, [&](uint32_t face) {
        if (near_count_ == near_.size()) return false;
        __builtin_prefetch(&s.faces[face]); // they are far apart in memory
        near_[near_count_++] = face;
        return true;
    });
    ++counters_.sweeps;
    counters_.triangles_tested += near_count_;
    // Past a quarter of what it may look at it counts as another one.
    sweeps_left_ -= static_cast<uint32_t>(std::min(1 + 4 * near_count_ / near_.size(), std::size_t{sweeps_left_}));
    return all;
}

// Whether the straight move meets an edge, or ends across a triangle, of those found on it.
bool StylusContact::blocked(const Shaft& to, const SweptRegion& swept, Obstacle& obstacle) noexcept
{
    const Surface& s = surface();
    bool met = false;
    obstacle.time = 1;
    obstacle.exact = false;
    close_ = {.height = near_enough};
    const Shaft& from = shaft_;
    const ShaftMove move(from, to);
    std::optional<Crossing> crossing;
    for (std::size_t i = 0; i < near_count_; ++i) {
        if (i + BoxTree::lookahead < near_count_)
            for (const uint32_t corner : s.faces[near_[i + BoxTree::lookahead]].vertex)
                __builtin_prefetch(&s.vertices[corner]);
        const uint32_t f = near_[i];
        const Face& face = s.faces[f];
        if (!swept.meets(s, f)) continue;
        Crossing here;
        here.face = f;
        if (!met && crosses(to.tip, to.tail, s.vertex(f, 0), s.vertex(f, 1), s.vertex(f, 2), here) &&
            (!crossing || earlier(here, *crossing)))
            crossing = here;
        for (uint32_t edge = 0; edge < 3; ++edge) {
            if (std::min(face.link[edge][0].face(), face.link[edge][1].face()) < f) continue; // tested from there
            const uint32_t a = face.vertex[edge], b = face.vertex[next(edge)];
            EdgeMeeting meeting;
            const bool is_met = move.meets(s.vertices[a], s.vertices[b], obstacle.time, meeting);
            if (!met && meeting.close) see(f, edge, to);
            if (!is_met || is_below_a_side(a, b, to)) continue;
            obstacle = {f, edge, meeting.time, meeting.side, false, 0};
            met = true;
        }
    }
    if (met) return true;

    if (!crossing) return false;
    // Where the straight ways led below a vertex it is the next edge that stops the shaft, not one below that.
    obstacle = {crossing->face, 0, 1, 0, true, 0};
    const auto& corners = s.faces[crossing->face].vertex;
    for (const bool below : {false, true}) {
        double nearest = HUGE_VAL;
        for (uint32_t edge = 0; edge < 3; ++edge) {
            const glm::dvec3 &a = edge_end(crossing->face, edge, 0), &b = edge_end(crossing->face, edge, 1);
            const Passing then = passing(to, a, b), now = passing(from, a, b);
            if (then.parallel || now.parallel || !then.within(0, reach)) continue;
            if (std::fabs(then.height) >= nearest) continue;
            if (is_below_a_side(corners[edge], corners[next(edge)], to) != below) continue;
            nearest = std::fabs(then.height);
            obstacle.edge = edge;
            obstacle.side = -side_of_line(from.tip, from.tail, a, b);
        }
        if (obstacle.side != 0) break;
    }
    return true;
}

// As far toward what was met as leaves a gap.
void StylusContact::approach(const Shaft& to, const Obstacle& obstacle) noexcept
{
    if (obstacle.exact) return;
    const glm::dvec3 &a = edge_end(obstacle.face, obstacle.edge, 0), &b = edge_end(obstacle.face, obstacle.edge, 1);
    const double height = std::fabs(passing(shaft_, a, b).height);
    if (!(height > 2 * rest_gap)) return;
    double time = obstacle.time * (1 - rest_gap / height);
    for (int attempt = 0; attempt < 3; ++attempt, time *= 0.5) {
        const Shaft there = (shaft_ + time * (to - shaft_)).rounded();
        Obstacle other;
        if (blocked(there, swept_to(there), other)) continue;
        shaft_ = there;
        return;
    }
}

// One more contact, in the place of what pushes least if there are too many.
void StylusContact::touch(const Obstacle& obstacle) noexcept
{
    if (obstacle.side == 0) return;
    const glm::dvec3 &a = edge_end(obstacle.face, obstacle.edge, 0), &b = edge_end(obstacle.face, obstacle.edge, 1);
    if (is_side(a, b)) return;
    if (side_count_ == sides_max) {
        const auto least = std::ranges::min_element(sides_, {}, &Side::push);
        drop(static_cast<uint32_t>(least - sides_.begin()));
    }
    sides_[side_count_++] = {.face = obstacle.face, .edge = obstacle.edge, .sign = double(obstacle.side)};
}

// Of edges that the shaft does not pass over any more, or does not come to pass over.
void StylusContact::let_go_of_ended() noexcept
{
    for (uint32_t i = side_count_; i-- > 0;) {
        Side& side = sides_[i];
        const Passing now = passing_of(side, shaft_);
        // Met beyond an end of the shaft, as by a tip that goes over a border: only now is it seen on which side.
        const int exact = now.parallel || !now.within(0, 0)
                              ? 0
                              : -side_of_line(shaft_.tip, shaft_.tail, edge_end(side.face, side.edge, 0),
                                              edge_end(side.face, side.edge, 1));
        if (exact != 0) side.sign = exact;
        const bool over = !now.parallel && now.within(let_go_by_end, let_go) && std::fabs(now.height) < 4 * rest_gap;
        const bool ahead = !side.reached && (side.fresh || side.push > 0);
        side.reached |= over;
        if (!over && !ahead && !meets_fresh(side)) drop(i);
    }
    for (Side& side : std::span(sides_.data(), side_count_)) side.fresh = false;
}

// Whether the side ends where one that was met in this round begins: in the corner of both it may rest on both.
bool StylusContact::meets_fresh(const Side& side) const noexcept
{
    const auto has = [&](const Side& other, uint32_t vertex) {
        const auto& corners = surface().faces[other.face].vertex;
        return corners[other.edge] == vertex || corners[next(other.edge)] == vertex;
    };
    const auto& corners = surface().faces[side.face].vertex;
    return std::any_of(sides_.begin(), sides_.begin() + side_count_, [&](const Side& other) {
        return &other != &side && other.fresh &&
               (has(other, corners[side.edge]) || has(other, corners[next(side.edge)]));
    });
}

void StylusContact::drop(uint32_t side) noexcept
{
    std::shift_left(sides_.begin() + side, sides_.begin() + side_count_--, 1);
}

} // namespace haptel::runtime
