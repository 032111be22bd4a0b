// How the ends of a stylus and its shaft come to agree: the pushes of the shaft's contacts say where the ends are
// aimed, the ends walk there, the shaft follows and meets new contacts.
#include "runtime/stylus_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace haptel::runtime {

using namespace shaft_tolerance;

namespace {

// Within which the ends are where they should be: two units, and this share of how far the hand is away.
// An end that slips goes its way in a few goes, each as far as friction lets it: for it, this share.
constexpr double settled = 2, settled_share = 1e-10, slipping_share = 1e-4;

// A contact that slides off its edge does so by this many units and this share of its way, so that it is not found
// there again, wherever the way bends.
constexpr double beyond = 16, past_the_end = 0.05;

// How often the directions of contacts follow the shaft that they turn.
constexpr int turns_max = 48;

// For so long a shaft may fall behind its ends, after a jump around things or where it is jammed; then it is let go.
constexpr uint32_t patience_ticks = 64;
constexpr double far_behind = 0x1p20; // lattice units: a millionth of the object

// What a way that was blocked by nothing new is cut to.
constexpr double shorter = 0.25;

} // namespace

// Where the ends that are tracked want the shaft to be.
Shaft StylusContact::goal() const noexcept
{
    Shaft goal = within(begin_ == 0 ? tip_.proxy_.at : aim_.tip, end_ == 1 ? tail_.proxy_.at : aim_.tail);
    if (begin_ == 0) goal.tip = beside(surface(), tip_.proxy_);
    if (end_ == 1) goal.tail = beside(surface(), tail_.proxy_);
    return goal;
}

// An end that begins anew at a free place.
void StylusContact::restart(PointContact& end, const glm::dvec3& at) noexcept
{
    end.proxy_.on = Proxy::On::nothing;
    end.proxy_.at = end.hand_ = end.true_hand_ = at;
    end.placed_ = true;
    end.clear_.radius = 0;
    end.describe();
}

void StylusContact::restart_ends() noexcept
{
    if (begin_ == 0) restart(tip_, shaft_.tip);
    if (end_ == 1) restart(tail_, shaft_.tail);
    astray_ = false;
}

// Ends and shaft in turn, until they agree.
void StylusContact::resolve(const EndsFriction& friction) noexcept
{
    if (astray_) restart_ends();
    bool stopped = false, tip_slides = false, tail_slides = false;
    WalkPath tip_path, tail_path;
    double stride = 1; // share of the hand's way that is tried at once
    uint32_t round = 0;
    sweeps_left_ = sweeps_max;
    Grips grips;
    grips.tip.friction = checked(friction.tip);
    grips.tail.friction = checked(friction.tail);
    for (; round < rounds_max && sweeps_left_ > 0; ++round) {
        Shaft aim, to = hand_;
        const double share = std::min(stride, solve(to, aim, grips));
        if (share < 1) {
            to = {reached_.tip + share * (to.tip - reached_.tip), reached_.tail + share * (to.tail - reached_.tail)};
            solve(to, aim, grips);
        }
        const bool slips = grips.tip.slips || grips.tail.slips;
        if (round > 0 && !stopped && share == 1 &&
            farther(aim, aim_) <= settled + (slips ? slipping_share : settled_share) * farther(aim, hand_))
            break;
        if (astray_) restart_ends();
        aim_ = aim;
        tip_path.count = tail_path.count = 0;
        Shaft clear = aim_;
        const auto go_tip = [&] {
            if (begin_ > 0) return;
            tip_.aim(clear.tip);
            tip_.go(grips.tip.of_walk(), &tip_path);
            tip_slides |= tip_.proxy_.sliding;
        };
        const auto go_tail = [&] {
            if (end_ < 1) return;
            tail_.aim(clear.tail);
            tail_.go(grips.tail.of_walk(), &tail_path);
            tail_slides |= tail_.proxy_.sliding;
        };
        if (grips.tail.drags() && !grips.tip.touches) {
            go_tail();
            clear.tail = tail_.proxy_.at;
            clear = clear_of_sides(clear, {true, false});
            go_tip();
        } else {
            go_tip();
            if (grips.tip.drags() && !grips.tail.touches) {
                clear.tip = tip_.proxy_.at;
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
    }
    counters_.walks_cut += stopped;
    stuck_ticks_ = stopped && farther(shaft_, goal()) > far_behind ? stuck_ticks_ + 1 : 0;
    if (stuck_ticks_ == patience_ticks) tracked_ = false;
    tip_.proxy_.sliding = tip_slides;
    tail_.proxy_.sliding = tail_slides;
    tip_.describe();
    tail_.describe();
    for (uint32_t i = side_count_; i-- > 0;)
        if (sides_[i].push == 0 && sides_[i].sign * passing_of(sides_[i], shaft_).height > 4 * rest_gap) drop(i);
}

// The end that gives makes way for the sides where friction has left the other elsewhere than it was to go: on a short
// lever that is far.
Shaft StylusContact::clear_of_sides(const Shaft& to, EndsGive gives) const noexcept
{
    std::array<ShaftContact, shaft_contacts_max> contacts;
    Shaft at = to;
    for (int turn = 0; turn < turns_max; ++turn) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < side_count_; ++i) {
            const Passing here = passing_of(sides_[i], {at.at(begin_), at.at(end_)});
            if (here.parallel || sides_[i].push == 0) continue;
            const glm::dvec3 normal = sides_[i].sign * here.normal;
            const double share = begin_ + here.on_shaft * (end_ - begin_);
            contacts[count++] = {normal, share, glm::dot(normal, here.edge_point) + rest_gap};
        }
        const auto push = pushes({contacts.data(), count}, to.tip, to.tail, gives);
        Shaft next = to;
        for (uint32_t i = 0; i < count; ++i) {
            if (gives.tip) next.tip += (1 - contacts[i].share) * push[i] * contacts[i].normal;
            if (gives.tail) next.tail += contacts[i].share * push[i] * contacts[i].normal;
        }
        const double change = farther(next, at);
        at = next;
        if (change < 0.25) break;
    }
    return at;
}

// An end as it begins: it sticks where it is. One that went where the shaft could not follow comes back first.
void StylusContact::take_hold(Grip& grip, const PointContact& end, const glm::dvec3& on_shaft) const noexcept
{
    grip.touches = end.proxy_.touches();
    grip.normal = end.contact_.normal;
    grip.at = end.proxy_.at;
    if (astray_) grip.at = on_shaft + glm::dot(grip.normal, grip.at - on_shaft) * grip.normal;
    grip.lag = glm::dvec3(0);
    const bool slides = end.proxy_.sliding && !astray_;
    grip.most = slides ? grip.friction.dynamic_coefficient : grip.friction.static_coefficient;
    grip.sticks = grip.touches && side_count_ > 0 && !grip.slips && grip.most > 0;
}

// What friction does if the end is aimed there, as the walk has it; returns by how much that is news, lattice units.
double StylusContact::Grip::follow(const glm::dvec3& aim) noexcept
{
    const glm::dvec3 from_aim = at - aim;
    const double height = glm::dot(normal, from_aim), depth = std::max(0.0, height);
    const glm::dvec3 back = from_aim - height * normal;
    const double way = glm::length(back);
    if (sticks) {
        if (way <= most * depth) return 0;
        sticks = false;
        slips = true;
        return HUGE_VAL;
    }
    const glm::dvec3 before =
        std::exchange(lag, way > 0 ? friction.dynamic_coefficient * depth / way * back : glm::dvec3(0));
    return glm::distance(lag, before);
}

// Where the ends are to be aimed for the sides to hold a hand; and the share of the way there on which each side that
// pushes stays within its edge and the shaft.
double StylusContact::solve(const Shaft& hand, Shaft& aim, Grips& grips) noexcept
{
    std::array<ShaftContact, shaft_contacts_max> contacts;
    Grip &tip = grips.tip, &tail = grips.tail;
    take_hold(tip, tip_, shaft_.tip);
    take_hold(tail, tail_, shaft_.tail);
    if (tip.sticks) tail.sticks = false; // one of them has to give

    Shaft at = shaft_;
    for (int turn = 0; turn < turns_max; ++turn) {
        for (uint32_t i = 0; i < side_count_; ++i) {
            Side& side = sides_[i];
            if (const Passing here = passing_of(side, at); !here.parallel) {
                side.normal = side.sign * here.normal;
                side.point = here.edge_point;
                side.share = begin_ + here.on_shaft * (end_ - begin_);
            }
            contacts[i] = {side.normal, side.share, glm::dot(side.normal, side.point) + rest_gap};
        }
        uint32_t count = side_count_;
        const auto add_end = [&](const Grip& grip, double share) {
            if (grip.touches && !grip.sticks) contacts[count++] = {grip.normal, share, glm::dot(grip.normal, grip.at)};
        };
        add_end(tip, 0);
        add_end(tail, 1);
        aim = hand;
        Shaft held{tip.sticks ? tip.at : hand.tip + tip.lag, tail.sticks ? tail.at : hand.tail + tail.lag};
        const auto push = pushes({contacts.data(), count}, held.tip, held.tail, {!tip.sticks, !tail.sticks});
        for (uint32_t i = 0; i < count; ++i) {
            const ShaftContact& contact = contacts[i];
            const glm::dvec3 by = push[i] * contact.normal;
            if (i < side_count_) {
                sides_[i].push = push[i];
                aim.tip += (1 - contact.share) * by;
                aim.tail += contact.share * by;
            }
            if (!tip.sticks) held.tip += (1 - contact.share) * by;
            if (!tail.sticks) held.tail += contact.share * by;
        }
        const Shaft next{held.at(begin_), held.at(end_)};
        double change = farther(next, at);
        at = next;
        if (tip.touches) change = std::max(change, tip.follow(aim.tip));
        if (tail.touches) change = std::max(change, tail.follow(aim.tail));
        if (side_count_ == 0 || change < 0.25) break;
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
