#include "runtime/contact/sphere_contact.h"

#include "runtime/contact/reach.h"
#include "runtime/geometry/finite.h"
#include "runtime/surface/collision.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace haptel::runtime {

namespace {

// Planes are picked anew where they are so many times as far as needed.
constexpr double stride_most = 8;

// Steps follow each other if they go the same way, by the cosine, and get so much shorter at least: one that is more
// than twice as long as it would be leads away from the hand. Where friction ends the way it may be more: what goes too
// far goes back.
constexpr double follows = 0.99, follows_most = 0.5, follows_rubbing = 0.8;

} // namespace

SphereContact::SphereContact(std::shared_ptr<const Surface> surface, std::optional<double> radius_m)
    : surface_(std::move(surface))
    , radius_(radius_m ? *radius_m / surface_->lattice.unit_m : Lattice::point_radius)
    , grown_(radius_)
    , is_point_(!radius_m)
    , faces_(*surface_)
{
    forget();
}

void SphereContact::reset() noexcept
{
    placed_ = false;
    proxy_ = {};
    forget();
    hand_ = hand_before_ = glm::dvec3(0);
    grown_ = radius_;
    contact_count_ = 0;
    contacts_[0] = {};
    (void)faces_.boxes();
    counters_ = {};
}

void SphereContact::tick(const glm::dvec3& hand_m, const Friction& friction, const glm::dvec3* tail) noexcept
{
    if (!finite(hand_m)) return;
    aim(surface_->lattice.units(hand_m));
    slide_on(surface_->lattice.metres(hand_) - contacts_[0].hand_m, friction);
    if (!placed_) {
        Crossing crossing;
        const bool enters = tail && first_crossing(*surface_, *tail, hand_, StartsOn::nothing(), crossing, counters_) &&
                            crossing.side == 0;
        place(enters ? *tail : hand_);
    }
    (void)move(friction);
}

void SphereContact::follow(const glm::dvec3& hand_m) noexcept
{
    if (!finite(hand_m)) return;
    aim(surface_->lattice.units(hand_m));
    proxy_.at = hand_;
    placed_ = true;
    if (grown_ < radius_) close_ = {}; // that was of a smaller one
    grown_ = radius_;                  // there is nothing
    tell_free();
}

// Lattice units.
void SphereContact::aim(const glm::dvec3& hand) noexcept
{
    hand_before_ = std::exchange(hand_, Lattice::snap_units(hand));
}

void SphereContact::slide_on(const glm::dvec3& way_m, const Friction& friction) noexcept
{
    proxy_.sliding = proxy_.sliding && proxy_.touches() && slides_on(contacts(), way_m, checked(friction));
}

// Where there is too little room for a ball it stays, and rounding may take it through a face.
void SphereContact::restart(const glm::dvec3& at) noexcept
{
    hand_ = hand_before_ = at;
    proxy_ = {};
    place(at);
    placed_ = true;
    tell_free();
}

double SphereContact::gap_m(const glm::dvec3& centre_m) const noexcept
{
    return std::max(0.0, surface_->gap_to_box_m(centre_m, centre_m) - radius_ * surface_->lattice.unit_m);
}

// Straight on toward the hand, at most so far. The plane that ends a way is seen from where it began: a point touches
// where it cannot go on.
void SphereContact::fly(double step_max) noexcept
{
    const glm::dvec3 to_hand = hand_ - proxy_.at;
    const double length = glm::length(to_hand), within = std::min(length, step_max);
    if (!(length > 0)) return;
    const double share = faces_.open(within / length * to_hand, 0);
    proxy_.at += share * within / length * to_hand;
    in_air_ = !(share < 1 && (!is_point_ || share * within <= touching_gap));
    if (!in_air_) pass();
}

// One straight step to where the planes around let it come nearest to the hand. Those that hold it are seen from here.
SphereContact::Held SphereContact::slide(double step_max, Stride& last, bool is_last) noexcept
{
    faces_.see_from(proxy_.at);
    const Held held = as_rows(is_point_ ? project(faces_.rows(), hand_, proxy_.at, distance_rounding)
                                        : project(faces_, hand_, proxy_.at, distance_rounding));
    if (solid_) return {};
    in_air_ = held.count == 0; // off again
    if (in_air_) last = {};
    const glm::dvec3 to = held.at - proxy_.at, way = is_last ? to : further(held, to, last);
    const double length = glm::length(way);
    proxy_.at += length > step_max ? step_max / length * way : way;
    if (length > step_max) last = {}; // the next step goes on with this one
    if (held.count > 0) pass();
    proxy_.sliding |= held.count > 0 && length > distance_rounding;
    return held;
}

// Round an edge or a vertex each step along its plane is the same share of the one before, of the depth over the
// radius: it goes at once as far as all that would follow.
glm::dvec3 SphereContact::further(const Held& held, const glm::dvec3& way, Stride& stride) noexcept
{
    stride.further = glm::dvec3(0);
    if (held.count != 1) return way;
    const glm::dvec3& normal = held.row[0].normal;
    const glm::dvec3 along = way - glm::dot(way, normal) * normal;
    const glm::dvec3 last = std::exchange(stride.along, along);
    if (last == glm::dvec3(0)) return way;
    const double length = glm::length(along), before = glm::length(last);
    if (!(length < (rubs() ? follows_rubbing : follows_most) * before) ||
        glm::dot(along, last) < follows * length * before)
        return way;
    const glm::dvec3 farther = way + length / (before - length) * along;
    if (faces_.open(farther, distance_rounding) < 1) return way;
    return stride.further = farther;
}

// A point is felt as a point, though it is held as a ball: what pushes it is what would hold its middle on the planes
// themselves. Who presses most comes first.
SphereContact::Held SphereContact::as_rows(const Projection<glm::dvec3>& found) noexcept
{
    solid_ = false;
    Held held{found.at, found.count, {}};
    for (std::size_t i = 0; i < found.count; ++i) {
        const uint32_t picked = found.active[i];
        solid_ |= faces_.is_solid(picked);
        held.row[i] = {faces_.face(picked), faces_.rows()[picked].normal, found.push[i]};
    }
    if (is_point_ && held.count == 1) {
        held.row[0].push = std::max(0.0, held.row[0].push - grown_);
    } else if (is_point_ && held.count > 1) {
        std::array<HalfSpace, 3> planes;
        for (std::size_t i = 0; i < held.count; ++i)
            planes[i] = {held.row[i].normal, glm::dot(held.row[i].normal, held.at) - grown_};
        const Projection<glm::dvec3> felt = project({planes.data(), held.count}, hand_, held.at, distance_rounding);
        for (Row& row : held.row) row.push = 0;
        for (std::size_t i = 0; i < felt.count; ++i) held.row[felt.active[i]].push = felt.push[i];
    }
    if (held.count > 1)
        std::sort(held.row.begin(), held.row.begin() + std::ptrdiff_t(held.count),
                  [](const Row& a, const Row& b) { return a.push > b.push; });
    return held;
}

// Toward the hand, as near as it can slide, or to where it touches.
SphereContact::Way SphereContact::travel(bool until_it_touches) noexcept
{
    path_length_ = 0;
    rests_ = false;
    in_air_ = !proxy_.touches();
    if (!in_air_) pass();
    Way done;
    auto& [held, round, cut, on_the_way, blind] = done;
    Stride last;
    uint32_t raised = 0;                                      // by rounding
    const double slides = glm::distance(hand_, hand_before_); // about so far, where it touches
    double stride = first_reach * slides;
    // A point meets few faces: what it slides by is looked at once.
    const double stride_first = stride;
    uint64_t seen = counters_.triangles_tested;
    for (;; ++round) {
        const double want = glm::distance(hand_, proxy_.at);
        if (want == 0) break;
        cut = round == rounds_max;
        if (cut) break;
        if (round > 0 && counters_.triangles_tested - seen > NearFaces::per_tick) {
            cut = on_the_way = true;
            break;
        }
        const double room =
            look_as_far_as(want, is_point_ && !in_air_ ? std::min(want, slides) : want, is_point_ && until_it_touches);
        if (room < 0) {
            blind = true;
            return done;
        }
        if (round == 0) seen = counters_.triangles_tested; // or one that needs a long look would never land
        const bool in_air = in_air_;
        const double open = std::min(want, room);
        stride = std::max(stride, is_point_ ? std::max(stride_first, least_reach * want) : least_reach * radius_);
        const double reach = in_air ? open : std::min(open, stride);
        double close = round == 0 || in_air || is_point_ ? -1 : close_.room(proxy_.at);
        if (close < reach || close_.margin > stride_most * stride) {
            // A ball that grows is wider than the planes that it had.
            const bool again = !in_air && (is_point_ ? round == 0 : grown_ == radius_);
            pick(reach, !again ? Laid::here : is_point_ ? Laid::ahead : Laid::before);
            close = reach;
        }
        const double step_max = std::min(open, close);
        const glm::dvec3 before = proxy_.at;
        if (in_air)
            fly(step_max);
        else
            held =
                rubs() ? rub(step_max, last, round + 1 == rounds_max) : slide(step_max, last, round + 1 == rounds_max);
        counters_.triangles_tested += faces_.boxes();
        if (solid_) {
            if (faces_.is_full()) forget(); // there is room where it looks anew
            solid_ = false;
            blind = true;
            return done;
        }
        const double step = glm::distance(before, proxy_.at);
        on_the_way = step > 0.5 * open;
        if (rests_) break;
        if (!in_air && held.count > 0 && glm::distance(proxy_.at, held.at) <= distance_rounding && stands(held)) break;
        if (in_air || in_air_) {
            if (until_it_touches && !in_air_) break;
            continue;
        }
        if (step <= std::max(4 * distance_rounding, centre_settled * radius_)) break;
        const bool is_sought = last.went_back || last.further != glm::dvec3(0);
        // A face that rounding has let it into raises it, and tilted where it ends: from there it is seen as it is.
        // The second time it goes to and fro by rounding.
        raised += !is_sought && glm::distance(hand_, proxy_.at) >= want;
        if (raised == 2) break;
        stride = next_reach(step, step > 0.9 * step_max);
    }
    return done;
}

// False: it is on its way to where it may rest.
bool SphereContact::move(const Friction& friction) noexcept
{
    friction_ = checked(friction);
    path_length_ = 0;
    if (!placed_) {
        tell_free();
        return false;
    }
    const bool in_air = !proxy_.touches();
    if (in_air && grown_ == radius_ && faces_.rows().empty() &&
        close_.room(proxy_.at) >= glm::distance(hand_, proxy_.at)) { // nothing is near
        proxy_.at = hand_;
        tell_free();
        return true;
    }
    const glm::dvec3 start = proxy_.at;
    Way way = travel(in_air);
    // How far it had looked around before decides how its way is cut into steps, and friction feels them: where it
    // comes to touch it goes there once more, knowing nothing. Whoever comes the same way then feels the same.
    if (in_air && !way.blind && (way.cut || !in_air_)) {
        proxy_.at = start;
        forget();
        way = travel(false);
    }
    if (way.blind) { // too much at once: what is touched stays touched
        ++counters_.walks_cut;
        keep_told();
        return false;
    }
    auto& [held, round, cut, on_the_way, blind] = way;
    if (in_air && held.count == 0 && glm::distance(proxy_.at, hand_) <= distance_rounding) proxy_.at = hand_;
    counters_.walk_steps += round;
    counters_.walks_cut += cut;
    grow();
    if (cut && (on_the_way || in_air_)) {
        keep_told();
        return false;
    }
    if (!rubs()) held.at = proxy_.at;
    if (held.count == 0)
        tell_free();
    else
        tell(held, held.at);
    return !cut;
}

bool SphereContact::go(const glm::dvec3& hand, const Friction& friction) noexcept
{
    aim(hand);
    grown_before_ = grown_;
    const bool rests = move(friction);
    proxy_.at = glm::round(proxy_.at);
    return rests;
}

// As wide as it has grown it may not fit there, and what it knows is of another width.
void SphereContact::come_back(const glm::dvec3& at) noexcept
{
    if (grown_ != grown_before_) forget();
    grown_ = grown_before_;
    proxy_.at = at;
}

void SphereContact::tell_held(const glm::dvec3& aim, std::span<const uint32_t> planes, std::span<const double> pushes,
                              const glm::dvec3& lag) noexcept
{
    hand_ = aim;
    Held held{proxy_.at, std::min<std::size_t>(planes.size(), 3), {}};
    for (std::size_t i = 0; i < held.count; ++i)
        held.row[i] = {faces_.face(planes[i]), faces_.rows()[planes[i]].normal, pushes[i]};
    if (held.count == 0) return tell_free();
    std::ranges::sort(std::span(held.row).first(held.count), std::greater(), &Row::push);
    tell(held, proxy_.at - lag);
}

} // namespace haptel::runtime
