// How the ends of a stylus and its shaft come to agree: the pushes of the shaft's contacts say where the ends are
// aimed, the ends walk there, the shaft follows and meets new contacts.
#include "runtime/contact/stylus_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace haptel::runtime {

using namespace shaft_tolerance;

namespace {

// Within which the ends are where they should be: two units, and this share of how far the hand is away. What friction
// holds on a short lever is known less well: this share.
constexpr double end_settled = 2, settled_share = 1e-10, dragged_share = 1e-4;
// Of its limit. Where both ends drag none is free to make way for an edge: they have to be right within the gap.
constexpr double friction_settled = 1e-6, both_settled = 1e-9;

// A contact that slides off its edge does so by this many units and this share of its way, so that it is not found
// there again, wherever the way bends.
constexpr double beyond = 16, past_the_end = 0.05;

// Lattice units: what a push may leave violated.
constexpr double push_settled = 1e-3;

// Share of the shaft: on a shorter lever an end does not make way. The edge is passing by the other end.
constexpr double least_lever = 1e-4;

// How often the directions of contacts follow the shaft that they turn.
constexpr int turns_max = 48;

// A shaft that is this far behind its ends, after a jump around things or where it is jammed, is let go after a while.
constexpr double far_behind = 0x1p20; // lattice units: a millionth of the object

// Lattice units: what a tick may draw the springs of the ends out by, the hand being where it is. More than gaps and
// rounding do.
constexpr double uphill = 4096;

// What a way that was blocked by nothing new is cut to.
constexpr double shorter = 0.25;

} // namespace

// Where the ends that are tracked want the shaft to be.
Shaft StylusContact::goal() const noexcept
{
    Shaft goal = within(begin_ == 0 ? tip_->proxy().at : aim_.tip, end_ == 1 ? tail_->proxy().at : aim_.tail);
    if (begin_ == 0) goal.tip = tip_->beside();
    if (end_ == 1) goal.tail = tail_->beside();
    return goal;
}

void StylusContact::restart_ends() noexcept
{
    if (begin_ == 0) tip_->restart(shaft_.tip);
    if (end_ == 1) tail_->restart(shaft_.tail);
    astray_ = false;
}

// Ends and shaft in turn, until they agree. Where they led away from the hand, back to where they were nearest to it:
// what the springs hold is given by the hand, not by how it is looked for where they give way.
void StylusContact::resolve(const EndsFriction& friction) noexcept
{
    const double away_first = away(shaft_);
    Place nearest = place();
    double nearest_away = away_first;
    if (astray_) restart_ends();
    bool stopped = false;
    WalkPath tip_path, tail_path;
    double stride = 1; // share of the hand's way that is tried at once
    uint32_t round = 0;
    sweeps_left_ = sweeps_max;
    FrictionOfEnds ends;
    ends.tip.friction = checked(friction.tip);
    ends.tail.friction = checked(friction.tail);
    const double unit_m = surface().lattice.unit_m;
    tip_->slide_on(unit_m * (hand_.tip - reached_.tip), friction.tip);
    tail_->slide_on(unit_m * (hand_.tail - reached_.tail), friction.tail);
    bool tip_slides = ends.tip.slides = tip_->proxy().sliding;
    bool tail_slides = ends.tail.slides = tail_->proxy().sliding;
    for (; round < rounds_max && sweeps_left_ > 0; ++round) {
        Shaft aim, to = hand_;
        const double share = std::min(stride, solve(to, aim, ends));
        if (share < 1) {
            to = {reached_.tip + share * (to.tip - reached_.tip), reached_.tail + share * (to.tail - reached_.tail)};
            solve(to, aim, ends);
        }
        const bool drags = ends.tip.drags() || ends.tail.drags();
        if (round > 0 && !stopped && share == 1 &&
            farther(aim, aim_) <= end_settled + (drags ? dragged_share : settled_share) * farther(aim, hand_))
            break;
        if (astray_) restart_ends();
        aim_ = aim;
        tip_path.count = tail_path.count = 0;
        Shaft clear = aim_;
        const auto go_tip = [&] {
            if (begin_ > 0) return;
            tip_->aim(clear.tip);
            tip_->go(ends.tip.of_walk(), &tip_path);
            tip_slides |= tip_->proxy().sliding;
        };
        const auto go_tail = [&] {
            if (end_ < 1) return;
            tail_->aim(clear.tail);
            tail_->go(ends.tail.of_walk(), &tail_path);
            tail_slides |= tail_->proxy().sliding;
        };
        // What friction drags goes first: a little off its aim, on a short lever that is far for the other end.
        if (ends.tail.drags() && !ends.tip.touches) {
            go_tail();
            clear.tail = tail_->proxy().at;
            clear = clear_of_sides(clear, {true, false});
            go_tip();
        } else {
            go_tip();
            if (ends.tip.drags() && !ends.tail.touches) {
                clear.tip = tip_->proxy().at;
                clear = clear_of_sides(clear, {false, true});
            }
            go_tail();
        }
        const uint32_t known = side_count_;
        astray_ = !drag(tip_path, tail_path);
        stopped = astray_ || share < 1;
        if (!astray_) {
            reached_ = to;
            stride = std::min(1.0, 2 * stride);
        } else if (side_count_ == known) {
            stride *= shorter;
            reached_ = extended(shaft_);
        }
        let_go_of_ended();
        if (const double now = away(shaft_); now < nearest_away) nearest = place(), nearest_away = now;
    }
    const bool behind = stopped && farther(shaft_, goal()) > far_behind;
    if (begin_ == 0 && end_ == 1 && away(shaft_) > nearest_away + uphill) {
        go_back(nearest);
        stopped = true;
    }
    counters_.walks_cut += stopped;
    stuck_ticks_ = behind && away_first - away(shaft_) < far_behind ? stuck_ticks_ + 1 : 0;
    if (stuck_ticks_ == patience_ticks_) tracked_ = false;
    if (let_go_of_unreached() || stopped) hold_hand_from_here(ends);
    tip_->set_sliding(tip_slides);
    tail_->set_sliding(tail_slides);
    tip_->describe(ends.tip.drags());
    tail_->describe(ends.tail.drags());
    for (uint32_t i = side_count_; i-- > 0;)
        if (sides_[i].push == 0 && sides_[i].sign * passing_of(sides_[i], shaft_).height > 4 * rest_gap) drop(i);
}

StylusContact::Place StylusContact::place() const noexcept
{
    return {shaft_, reached_, tip_->state(), tail_->state(), sides_, side_count_, astray_};
}

void StylusContact::go_back(const Place& to) noexcept
{
    shaft_ = to.shaft, reached_ = to.reached;
    tip_->go_back(to.tip), tail_->go_back(to.tail);
    sides_ = to.sides, side_count_ = to.side_count;
    astray_ = to.astray;
    clear_.radius = 0; // it may be out of it
}

// How far the springs of both ends are drawn where the part in the workspace is there: their energy is half the
// stiffness times its square.
double StylusContact::away(const Shaft& part) const noexcept
{
    const Shaft whole = extended(part);
    const glm::dvec3 tip = whole.tip - hand_.tip, tail = whole.tail - hand_.tail;
    return std::sqrt(glm::dot(tip, tip) + glm::dot(tail, tail));
}

// What pushes the hand while the shaft is not where it should be: the ends were aimed at less of the hand's way, or at
// what a side left them that is gone. It is all of the hand that is held, by the contacts as they are here.
void StylusContact::hold_hand_from_here(FrictionOfEnds& ends) noexcept
{
    solve(hand_, aim_, ends, Turning::not_at_all);
    if (begin_ == 0 && tip_->proxy().touches()) tip_->aim(aim_.tip);
    if (end_ == 1 && tail_->proxy().touches()) tail_->aim(aim_.tail);
}

// With the end that gives where it clears the sides that push, the other being where it is.
Shaft StylusContact::clear_of_sides(const Shaft& to, EndsGive gives) const noexcept
{
    std::array<ShaftRow, sides_max> rows;
    Shaft at = to;
    for (int turn = 0; turn < turns_max; ++turn) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < side_count_; ++i) {
            const Passing here = passing_of(sides_[i], {at.at(begin_), at.at(end_)});
            if (here.parallel || sides_[i].push == 0) continue;
            const glm::dvec3 normal = sides_[i].sign * here.normal;
            const double share = begin_ + here.on_shaft * (end_ - begin_);
            if ((gives.tip ? 1 - share : share) < least_lever) continue;
            rows[count++] = {normal, glm::dot(normal, here.edge_point) + rest_gap, share};
        }
        const Shaft next = project({rows.data(), count}, to, push_settled, gives).at;
        const double change = farther(next, at);
        at = next;
        if (change < 0.25) break;
    }
    return at;
}

// An end as it begins. One that went where the shaft could not follow comes back first.
void StylusContact::take_hold(EndFriction& end_friction, const EndContact& end,
                              const glm::dvec3& on_shaft) const noexcept
{
    end_friction.touches = end.proxy().touches();
    end_friction.normal = end.normal();
    end_friction.unfelt = glm::dot(end.unfelt(), end.normal());
    end_friction.bears = end.bears();
    end_friction.at = end.proxy().at;
    if (astray_)
        end_friction.at = on_shaft + glm::dot(end_friction.normal, end_friction.at - on_shaft) * end_friction.normal;
    end_friction.take_hold(side_count_ > 0);
}

// Where the ends are to be aimed for the sides to hold a hand; and the share of the way there on which each side that
// pushes stays within its edge and the shaft. `normals`: of the sides; not turned they are those where the shaft is.
double StylusContact::solve(const Shaft& hand, Shaft& aim, FrictionOfEnds& ends, Turning normals) noexcept
{
    std::array<ShaftRow, sides_max + 2> rows;
    EndFriction &tip = ends.tip, &tail = ends.tail;
    take_hold(tip, *tip_, shaft_.tip);
    take_hold(tail, *tail_, shaft_.tail);
    aim = hand;
    if (side_count_ == 0) return 1;
    if (tip.sticks) tail.sticks = false; // else no side could push; it may stay where it is for all that

    Shaft at = shaft_;
    for (int turn = 0; turn < turns_max; ++turn) {
        for (uint32_t i = 0; i < side_count_; ++i) {
            Side& side = sides_[i];
            const Passing here = passing_of(side, normals == Turning::with_the_shaft ? at : shaft_);
            if (!here.parallel) {
                side.normal = side.sign * here.normal;
                side.point = here.edge_point;
                side.share = begin_ + here.on_shaft * (end_ - begin_);
            }
            rows[i] = {side.normal, glm::dot(side.normal, side.point) + rest_gap, side.share};
        }
        uint32_t count = side_count_;
        const auto add_end = [&](const EndFriction& end_friction, double arm) {
            if (end_friction.touches && !end_friction.sticks)
                rows[count++] = {end_friction.normal, glm::dot(end_friction.normal, end_friction.at), arm};
        };
        add_end(tip, 0);
        add_end(tail, 1);
        if (normals == Turning::not_at_all) // the shaft is where it may be: no more is held than the springs are drawn
            for (ShaftRow& row : std::span(rows.data(), count))
                row.offset = std::min(row.offset, glm::dot(row.normal, extended(shaft_).at(row.arm)));
        const std::span<const ShaftRow> all(rows.data(), count);
        const EndsGive gives{!tip.sticks, !tail.sticks};
        aim = hand;
        const Shaft free{gives.tip ? hand.tip + tip.lag : tip.at, gives.tail ? hand.tail + tail.lag : tail.at};
        const Projection<Shaft> pushed = project(all, free, push_settled, gives);
        const Shaft& held = pushed.at;
        for (uint32_t i = 0; i < side_count_; ++i) sides_[i].push = 0;
        for (std::size_t k = 0; k < pushed.count; ++k) {
            const uint32_t i = pushed.active[k];
            if (i >= side_count_) continue;
            const glm::dvec3 by = pushed.push[k] * rows[i].normal;
            sides_[i].push = pushed.push[k];
            aim.tip += (1 - rows[i].arm) * by;
            aim.tail += rows[i].arm * by;
        }
        const Shaft next{held.at(begin_), held.at(end_)};
        bool agreed = farther(next, at) < 0.25;
        at = next;
        double news = 0;
        if (tip.drags()) news = tip.follow(aim.tip, held.tip, compliance(ShaftEnd::tip, all, pushed, gives));
        if (tail.drags())
            news = std::max(news, tail.follow(aim.tail, held.tail, compliance(ShaftEnd::tail, all, pushed, gives)));
        agreed &= news < (tip.drags() && tail.drags() ? both_settled : friction_settled);
        for (EndFriction* end_friction : {&tip, &tail}) {
            if (!agreed || !end_friction->drags() || !end_friction->moves || end_friction->slides) continue;
            end_friction->slides = true; // more than static friction holds: from here on dynamic friction does
            agreed = false;
        }
        if (agreed) break;
    }

    double share = 1;
    for (uint32_t i = 0; i < side_count_; ++i) {
        if (sides_[i].push == 0) continue;
        const Passing now = passing_of(sides_[i], shaft_), then = passing_of(sides_[i], at);
        if (now.parallel || then.parallel) continue;
        const auto stay = [&](double from, double to, double low, double high) {
            const double over = past_the_end * std::fabs(to - from);
            low -= over, high += over;
            const double end = to < low ? low : to > high ? high : to;
            if (end != to && from > low && from < high) share = std::min(share, (end - from) / (to - from));
        };
        const double off = let_go + beyond, off_shaft = (let_go_by_end + beyond) / now.shaft_length;
        stay(now.on_edge, then.on_edge, -off, now.edge_length + off);
        stay(now.on_shaft, then.on_shaft, -off_shaft, 1 + off_shaft);
    }
    return share;
}

} // namespace haptel::runtime
