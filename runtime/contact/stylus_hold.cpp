// How a stylus is held: the planes of both its ends and the edges that its shaft rests on are rows of one projection.
// It says where the rows let the stylus come nearest to the hand; there it goes straight, as far as it knows what is
// around its ends and as its shaft meets no other edge, and looks again.
#include "runtime/contact/reach.h"
#include "runtime/contact/stylus_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace haptel::runtime {

using namespace shaft_tolerance;

namespace {

// A step is none that is below so many lattice units, and this share of what the springs are drawn by: an end that is
// off by a unit sees its planes turned by that over its radius, and the hand is held elsewhere by as much.
constexpr double step_settled = 4, turned_settled = step_settled / rest_gap;

// As friction_settled. Where both ends drag none is free to make way for an edge: they have to be right within the gap.
constexpr double both_settled = 1e-9;

// How often the directions of contacts follow the shaft that they turn, unless that moves it by less (lattice units).
constexpr int turns_max = 48;
constexpr double turn_settled = 0.25;

// A shaft that is this far behind its ends, after a jump around things or where it is jammed, is let go after a while.
constexpr double far_behind = 0x1p20; // lattice units: a millionth of the object

// The radius is not felt, nor what it makes of places: on a lever, and between walls at an angle, more than itself.
constexpr double unfelt_most = 16 * rest_gap;

// What a tick may draw the springs of the ends out by, the hand being where it is: what comes down is held up by its
// radius.
constexpr double uphill = 4 * rest_gap;

// What a way that was blocked by nothing new is cut to.
constexpr double shorter = 0.25;

} // namespace

// Rows of both ends, with what friction needs of them: an end that friction may hold is borne by the planes that it
// touches, and comes to touch others where its way leads it. False: it cannot be looked at.
bool StylusContact::look(double reach, const FrictionOfEnds& ends, bool is_first) noexcept
{
    row_count_ = 0;
    const auto look_from = [&](SphereContact& end, bool is_held, const glm::dvec3& at, bool drags, EndRows& rows,
                               double arm) {
        rows = {row_count_, 0, std::numeric_limits<double>::infinity()};
        if (!is_held) return true;
        rows.reach = end.look_from(at, reach, planes_max, is_first);
        if (rows.reach == 0) return false;
        const std::size_t count = drags ? end.touching() : end.planes().size();
        for (const HalfSpace& plane : end.planes().first(count))
            rows_[row_count_++] = {plane.normal, plane.offset, arm};
        rows.count = static_cast<uint32_t>(count);
        return true;
    };
    return look_from(*tip_, begin_ == 0, shaft_.tip, ends.tip.friction.static_coefficient > 0, tip_rows_, 0) &&
           look_from(*tail_, end_ == 1, shaft_.tail, ends.tail.friction.static_coefficient > 0, tail_rows_, 1);
}

// Rows of the sides, turned with the shaft, behind those of the ends.
std::span<const ShaftRow> StylusContact::turn_sides(const Shaft& at, double gap) noexcept
{
    for (uint32_t i = 0; i < side_count_; ++i) {
        Side& side = sides_[i];
        if (const Passing here = passing_of(side, at); !here.parallel) {
            side.normal = side.sign * here.normal;
            side.point = here.edge_point;
            side.share = begin_ + here.on_shaft * (end_ - begin_);
        }
        rows_[row_count_ + i] = {side.normal, glm::dot(side.normal, side.point) + gap, side.share};
    }
    return {rows_.data(), row_count_ + side_count_};
}

// What bears an end: the planes by which a stylus without friction would be held.
void StylusContact::take_hold(EndFriction& friction, const EndRows& rows, const Projection<Shaft>& held,
                              const glm::dvec3& at, double radius) const noexcept
{
    glm::dvec3 push(0);
    double sum = 0;
    std::array<HalfSpace, 6> planes;
    std::size_t count = 0;
    for (std::size_t k = 0; k < held.count; ++k) {
        const uint32_t i = held.active[k];
        if (i < rows.first || i >= rows.first + rows.count) continue;
        push += held.push[k] * rows_[i].normal;
        sum += held.push[k];
        planes[count++] = {rows_[i].normal, radius};
    }
    const double length = glm::length(push);
    friction.touches = length > 0;
    friction.at = at;
    if (friction.touches) {
        friction.normal = push / length;
        friction.bears = sum / length;
        const glm::dvec3 unfelt =
            project(std::span<const HalfSpace>(planes.data(), count), glm::dvec3(0), 2 * radius * friction.normal, 0)
                .at;
        friction.unfelt = glm::dot(unfelt, friction.normal);
    }
    friction.take_hold(side_count_ > 0);
}

// Where the rows hold the hand, with the friction that goes with it.
Projection<Shaft> StylusContact::solve(FrictionOfEnds& ends) noexcept
{
    EndFriction &tip = ends.tip, &tail = ends.tail;
    const auto turned = [&](auto&& friction_follows, Shaft at, Projection<Shaft> held = {}, bool is_held = false) {
        for (int turn = 0; turn < turns_max; ++turn) {
            const std::span<const ShaftRow> rows = turn_sides(at, rest_gap);
            const EndsGive gives{!tip.sticks, !tail.sticks};
            const Shaft target{gives.tip ? hand_.tip + tip.lag : tip.at, gives.tail ? hand_.tail + tail.lag : tail.at};
            if (turn > 0 || !is_held) held = project(rows, target, distance_rounding, gives);
            const Shaft next{held.at.at(begin_), held.at.at(end_)};
            const bool agreed = side_count_ == 0 || farther(next, at) < turn_settled;
            at = next;
            if (friction_follows(rows, held, gives, agreed)) break;
        }
        return held;
    };
    tip.sticks = tail.sticks = false;
    const glm::dvec3 tip_lag = tip.lag, tail_lag = tail.lag;
    tip.lag = tail.lag = glm::dvec3(0);
    const Projection<Shaft> free = turned([](auto&, auto&, auto&, bool agreed) { return agreed; }, shaft_);
    if (tip.friction.static_coefficient == 0 && tail.friction.static_coefficient == 0) return free;
    const bool begins_free = side_count_ == 0; // else what friction was is nearer to what it will be
    if (!begins_free) tip.lag = tip_lag, tail.lag = tail_lag;
    take_hold(tip, tip_rows_, free, shaft_.tip, tip_->radius());
    take_hold(tail, tail_rows_, free, shaft_.tail, tail_->radius());
    if (tip.sticks) tail.sticks = false; // else no side could push; it may stay where it is for all that
    if (!tip.drags() && !tail.drags()) return free;
    // By turns: each gives way to the other's friction.
    struct {
        double tip, tail;
    } news{tip.drags() ? HUGE_VAL : 0, tail.drags() ? HUGE_VAL : 0};
    bool of_tip = false;
    return turned(
        [&](std::span<const ShaftRow> rows, const Projection<Shaft>& held, EndsGive gives, bool agreed) {
            Shaft aim = hand_;
            for (std::size_t k = 0; k < held.count; ++k) {
                const ShaftRow& row = rows[held.active[k]];
                if (held.active[k] < row_count_) continue;
                aim += row.pushed(held.push[k]);
            }
            of_tip = tip.drags() && !(of_tip && tail.drags());
            if (of_tip)
                news.tip = tip.follow(aim.tip, held.at.tip, compliance(ShaftEnd::tip, rows, held, gives));
            else
                news.tail = tail.follow(aim.tail, held.at.tail, compliance(ShaftEnd::tail, rows, held, gives));
            agreed &= std::max(news.tip, news.tail) < (tip.drags() && tail.drags() ? both_settled : friction_settled);
            for (EndFriction* end : {&tip, &tail}) {
                if (!agreed || !end->drags() || !end->moves || end->slides) continue;
                end->slides = true; // more than static friction holds: from here on dynamic friction does
                agreed = false;
            }
            return agreed;
        },
        shaft_, free, begins_free);
}

// A share of the straight way to there. The straight ways of a shaft's ends lead it below an edge on which it turns and
// slides: where it rests is found for a hand that is as much nearer.
Shaft StylusContact::on_the_way(const Shaft& to, double share, const FrictionOfEnds& ends) noexcept
{
    const auto between = [share](const glm::dvec3& from, const glm::dvec3& there) {
        return from + share * (there - from);
    };
    const Shaft part = shaft_ + share * (to - shaft_);
    if (share == 1 || side_count_ == 0) return part.rounded();
    const Shaft whole = extended(shaft_);
    const EndsGive gives{!ends.tip.sticks, !ends.tail.sticks};
    const Shaft hand{gives.tip ? between(whole.tip, hand_.tip + ends.tip.lag) : ends.tip.at,
                     gives.tail ? between(whole.tail, hand_.tail + ends.tail.lag) : ends.tail.at};
    Shaft at = part;
    for (int turn = 0; turn < turns_max; ++turn) {
        const Shaft held = project(turn_sides(at, rest_gap), hand, distance_rounding, gives).at;
        const Shaft next{held.at(begin_), held.at(end_)};
        const bool agreed = farther(next, at) < turn_settled;
        at = next;
        if (agreed) break;
    }
    const auto is_known = [](bool is_held, const SphereContact& end, const EndRows& rows, const glm::dvec3& from,
                             const glm::dvec3& there) {
        return !is_held || (glm::distance(from, there) <= rows.reach &&
                            open_share(end.planes(), from, there - from, distance_rounding) == 1);
    };
    const bool known = is_known(begin_ == 0, *tip_, tip_rows_, shaft_.tip, at.tip) &&
                       is_known(end_ == 1, *tail_, tail_rows_, shaft_.tail, at.tail);
    return (known ? at : part).rounded();
}

void StylusContact::resolve(const EndsFriction& friction) noexcept
{
    FrictionOfEnds ends;
    ends.tip.friction = checked(friction.tip);
    ends.tail.friction = checked(friction.tail);
    const double unit_m = surface().lattice.unit_m;
    tip_->slide_on(unit_m * (hand_.tip - reached_.tip), friction.tip);
    tail_->slide_on(unit_m * (hand_.tail - reached_.tail), friction.tail);
    ends.tip.slides = tip_->proxy().sliding;
    ends.tail.slides = tail_->proxy().sliding;
    sweeps_left_ = sweeps_max;
    met_ = {};
    if (go_apart(friction)) return;
    const double away_first = away(shaft_);
    const Shaft shaft_first = shaft_;
    const auto sides_first = sides_;
    const uint32_t side_count_first = side_count_;
    tip_->set_sliding(ends.tip.slides);
    tail_->set_sliding(ends.tail.slides);
    if (contact_count_ == 0) { // whoever comes to touch from the same place feels the same
        tip_->forget();
        tail_->forget();
    }
    double stride = first_reach * farther(hand_, reached_);
    double most = 1; // share of the way that is tried at once
    bool settled = false, blind = false;
    Shaft to = shaft_;
    uint32_t round = 0;
    for (; sweeps_left_ > 0; ++round) {
        stride = std::max({stride, 64.0, least_reach * farther(extended(shaft_), hand_)});
        blind = !look(stride, ends, round == 0);
        if (blind) break;
        const Projection<Shaft> held = solve(ends);
        to = {held.at.at(begin_), held.at.at(end_)};
        for (Side& side : std::span(sides_.data(), side_count_)) side.push = 0;
        for (std::size_t k = 0; k < held.count; ++k)
            if (held.active[k] >= row_count_) sides_[held.active[k] - row_count_].push = held.push[k];
        const double known = known_share(to, stride, held, ends), share = std::min(most, known);
        const Shaft next = on_the_way(to, share, ends);
        const double step = farther(next, shaft_);
        settled = farther(to, shaft_) <= step_settled + turned_settled * away(shaft_);
        if (settled || step == 0) break;
        const uint32_t met = side_count_;
        const bool moved = move(next);
        if (moved)
            most = std::min(1.0, 2 * most);
        else if (side_count_ == met)
            most *= shorter;
        let_go_of_ended();
        const bool to_the_end = share == known && known < 1;
        stride = std::max(next_reach(step, to_the_end), to_the_end ? stride : 0.0);
    }
    if (away(shaft_) > away_first + uphill) { // what the springs hold is given by the hand, not by how that is found
        shaft_ = shaft_first, sides_ = sides_first, side_count_ = side_count_first;
        ends.tip.slides = tip_->proxy().sliding, ends.tail.slides = tail_->proxy().sliding;
        ends.tip.lag = ends.tail.lag = glm::dvec3(0);
        settled = false;
    }
    counters_.walk_steps += round;
    counters_.walks_cut += !settled;
    const bool behind = !settled && (blind || farther(shaft_, to) > far_behind);
    stuck_ticks_ = behind && away_first - away(shaft_) < far_behind ? stuck_ticks_ + 1 : 0;
    if (stuck_ticks_ == patience_ticks_) tracked_ = false;
    reached_ = hand_;
    // Edges that it was stopped by on its way, and has not come to pass over: it found another way. Nothing pushes
    // there.
    for (uint32_t i = side_count_; i-- > 0;)
        if (!sides_[i].reached) drop(i);
    tip_->set_sliding(ends.tip.slides);
    tail_->set_sliding(ends.tail.slides);
    hold(ends, settled);
}

// How far the springs of both ends are drawn where the part in the workspace is there: their energy is half the
// stiffness times its square.
double StylusContact::away(const Shaft& part) const noexcept
{
    return length(extended(part) - hand_);
}

// What holds it where it is. No more is held than the springs are drawn: rows that it has not come to begin here. It is
// felt as a line without a radius.
void StylusContact::hold(const FrictionOfEnds& ends, bool settled) noexcept
{
    for (Side& side : std::span(sides_.data(), side_count_)) side.push = 0;
    const Shaft whole = extended(shaft_);
    // What a line may come to that a ball does not. Where there is too much all of it is left.
    if (!look(rest_gap, {}, false)) {
        left_ = whole - hand_;
        tip_->tell_held(hand_.tip, {}, {}, glm::dvec3(0));
        tail_->tell_held(hand_.tail, {}, {}, glm::dvec3(0));
        return;
    }
    const Shaft target{hand_.tip + ends.tip.lag, hand_.tail + ends.tail.lag};
    std::span<const ShaftRow> rows = turn_sides(shaft_, rest_gap);
    const std::span<ShaftRow> changed(rows_.data(), rows.size());
    if (!settled)
        for (ShaftRow& row : changed) row.offset = std::min(row.offset, glm::dot(row.normal, whole.at(row.arm)));
    const uint32_t of_tip = tip_rows_.count;
    for (uint32_t i = 0; i < rows.size(); ++i)
        changed[i].offset -= i < of_tip ? tip_->radius() : i < row_count_ ? tail_->radius() : rest_gap;
    Projection<Shaft> held;
    Shaft at = shaft_;
    for (int turn = 0; turn < turns_max; ++turn) { // what is told is told by the rows that were projected last
        if (turn > 0) rows = turn_sides(at, 0);
        held = project(rows, target, push_settled);
        const Shaft next{held.at.at(begin_), held.at.at(end_)};
        const bool agreed = !settled || side_count_ == 0 || farther(next, at) < turn_settled;
        const bool is_near = farther(next, shaft_) < unfelt_most; // from farther off edges may lie beyond its ends
        if (agreed || (!is_near && at == shaft_)) break;
        at = is_near ? next : shaft_;
    }
    // In a fold that a line gets into, and a ball does not, more than the radius is left.
    const double off = farther(whole, held.at), left = off > unfelt_most ? 1 - unfelt_most / off : 0.0;
    left_ = left * (whole - held.at);
    const double drawn = away(shaft_);
    Shaft aim = hand_;
    std::array<uint32_t, 6> planes[2];
    std::array<double, 6> pushes[2];
    std::size_t count[2] = {0, 0};
    for (std::size_t k = 0; k < held.count; ++k) {
        const uint32_t i = held.active[k];
        const double push = held.push[k];
        if (push >= opposed_most * drawn) { // what they push together is told as what is left
            left_ += rows[i].pushed(push);
            continue;
        }
        if (i >= row_count_) {
            sides_[i - row_count_].push = push;
            aim += rows[i].pushed(push);
            continue;
        }
        const int end = i >= of_tip;
        planes[end][count[end]] = i - (end ? of_tip : 0);
        pushes[end][count[end]++] = push;
    }
    tip_->tell_held(aim.tip, {planes[0].data(), count[0]}, {pushes[0].data(), count[0]}, ends.tip.lag);
    tail_->tell_held(aim.tail, {planes[1].data(), count[1]}, {pushes[1].data(), count[1]}, ends.tail.lag);
}

} // namespace haptel::runtime
