// How friction holds a ball: on the way that it went in a tick, where what bears it there is enough.
#include "runtime/contact/sphere_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptel::runtime {

namespace {

// Cosine between the normals of what a ball slides along in a tick, and of what it comes to.
constexpr double same_wall = 0.9;

} // namespace

// A point goes along what it touches as the walk does, from one plane to the next: the way ends early, by the
// coefficient times what presses, or does not begin.
SphereContact::Held SphereContact::rub(double step_max) noexcept
{
    double gone = 0;
    for (uint32_t turn = 0;; ++turn) {
        const auto [touching, gap] = faces_.touching(proxy_.at, touching_gap);
        const Projection<glm::dvec3> found =
            project(faces_.rows().first(touching), hand_, proxy_.at, distance_rounding);
        if (found.count == 0 || gap > touching_gap) { // off again, or its way has led straight over an edge
            path_begin_ = path_length_;
            return {};
        }
        const Held held = as_rows(found);
        const glm::dvec3 way = held.at - proxy_.at;
        const double length = glm::length(way), share = share_past(length, held.pushes());
        rests_ = share == 0 && turn == 0; // else planes are seen from elsewhere, where it may have come off them
        if (share == 0) return held;
        const double within = std::min(share * length, step_max - gone);
        const glm::dvec3 step = within / length * way;
        const double open = open_share(faces_.rows(), proxy_.at, step, distance_rounding);
        proxy_.at += open * step;
        gone += open * within;
        pass(held);
        if (open == 1 || turn + 1 == turns_max) return held;
    }
}

// Of a way along what bears it by so much, the share that friction leaves. 0: it holds.
double SphereContact::share_past(double way, double pressed) noexcept
{
    const auto [rest, slide] = friction_;
    const double remaining = way - slide * pressed;
    const bool rounding = remaining <= distance_rounding;
    if (way <= (proxy_.sliding ? slide : rest) * pressed || (rounding && slide > 0)) return 0;
    proxy_.sliding = proxy_.sliding || !rounding;
    return remaining / way;
}

// Which of the rows held the ball already where a piece of its path begins, by bits. It may not have come to all that
// would have held it at the end of the piece before.
uint32_t SphereContact::borne_by(const Held& held, const Step& from) noexcept
{
    uint32_t bits = 0;
    for (std::size_t i = 0; i < held.count; ++i)
        for (std::size_t k = 0; k < from.held.count; ++k)
            if (glm::dot(held.row[i].normal, from.held.row[k].normal) > same_wall &&
                glm::dot(from.held.row[k].normal, from.at - from.held.at) <= touching_gap)
                bits |= 1u << i;
    return bits;
}

// Those of the rows alone, and where they would hold the ball.
SphereContact::Held SphereContact::only(const Held& held, uint32_t bits) const noexcept
{
    std::array<HalfSpace, 3> planes;
    std::array<uint32_t, 3> row;
    std::size_t count = 0;
    for (uint32_t i = 0; i < held.count; ++i)
        if (bits >> i & 1) {
            planes[count] = {held.row[i].normal, glm::dot(held.row[i].normal, held.at)};
            row[count++] = i;
        }
    const Projection<glm::dvec3> found = project({planes.data(), count}, hand_, held.at, distance_rounding);
    Held alone{found.at, found.count, {}};
    for (std::size_t i = 0; i < found.count; ++i) {
        alone.row[i] = held.row[row[found.active[i]]];
        alone.row[i].push = found.push[i];
    }
    take_off_radius(alone);
    return alone;
}

// Friction is a way that ends early, where what is left of it is the coefficient times what presses, or does not begin.
// It is borne by what holds the ball at the end of its way, as far as it has come to that; before it has, by what it
// slides along.
void SphereContact::hold_by_friction(Held& held) noexcept
{
    const auto [rest, slide] = friction_;
    if (rest == 0) {
        proxy_.sliding |= path_length_ > 0 && glm::distance(path_[0].at, proxy_.at) > distance_rounding;
        return;
    }
    for (uint32_t end = 1; end < path_length_; ++end) {
        const Step& begin = path_[end - 1];
        if (path_[end].held.count == 0) continue; // it flew
        const bool is_last_piece = end > path_begin_ && held.count > 0;
        const bool by_own = !is_last_piece || (end == 1 && borne_by(held, begin) == 0);
        const Held& bears = by_own ? path_[end].held : held;
        const uint32_t bits = borne_by(bears, begin), all = (1u << bears.count) - 1;
        const bool in_part = bits != 0 && bits != all;
        const Held part = in_part ? only(bears, bits) : Held();
        const Held& by = in_part ? part : bears;
        const double depth = glm::distance(by.at, hand_), pushes = by.pushes();
        if (depth == 0) continue;
        const glm::dvec3 normal = (by.at - hand_) / depth;
        struct Lag {
            glm::dvec3 across; // at a right angle to the push
            double up;         // along it
            double limit;      // of `across`, by a coefficient of 1
        };
        const auto lag_at = [&](const glm::dvec3& place) {
            const glm::dvec3 lag = place - by.at;
            const double up = glm::dot(lag, normal);
            return Lag{lag - up * normal, up, pushes / depth * std::max(0.0, depth + up)}; // in a groove by both walls
        };
        // Nor is a way that leads down held higher than the end of it bears.
        const auto holds = [&](const Lag& lag, double coefficient) {
            const double most = coefficient * lag.limit;
            return glm::dot(lag.across, lag.across) <= most * most && lag.up <= coefficient * pushes;
        };
        const Lag at_begin = lag_at(begin.at), at_end = lag_at(path_[end].at);
        if (end == 1) {
            if (holds(at_begin, proxy_.sliding ? slide : rest)) {
                proxy_.at = begin.at;
                path_length_ = end;
                held = by;
                return;
            }
            proxy_.sliding |= glm::length(at_begin.across) - slide * at_begin.limit > distance_rounding;
        }
        if (by_own || !holds(at_end, slide)) continue;
        // Where along this piece, beginning at its end, the two are equal: a quadratic equation.
        const glm::dvec3 across = at_begin.across - at_end.across;
        const double limit = slide * at_end.limit, more = slide * at_begin.limit - limit;
        const double a = glm::dot(across, across) - more * more, b = glm::dot(at_end.across, across) - limit * more;
        const double c = std::min(0.0, glm::dot(at_end.across, at_end.across) - limit * limit);
        const double root = std::sqrt(std::max(0.0, b * b - a * c));
        double share = std::min(1.0, b > 0 ? -c / (b + root) : a > 0 ? (root - b) / a : 1.0);
        if (at_begin.up > slide * pushes && at_begin.up > at_end.up)
            share = std::min(share, std::max(0.0, slide * pushes - at_end.up) / (at_begin.up - at_end.up));
        const glm::dvec3 place = path_[end].at + share * (begin.at - path_[end].at);
        proxy_.at = path_[end].at = place;
        path_length_ = end + 1;
        held = by;
        return;
    }
}

} // namespace haptel::runtime
