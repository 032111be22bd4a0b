// How friction holds a ball.
#include "runtime/contact/sphere_contact.h"

#include <algorithm>
#include <optional>

namespace haptel::runtime {

namespace {

// Of the radius and of its depth: who is off what it slid along by no more is on its way round that.
constexpr double lifted = 1.0 / 64;

} // namespace

// It goes along what it touches as the walk does, from one plane to the next: the way ends early, by the coefficient
// times what presses, or does not begin.
SphereContact::Held SphereContact::rub(double step_max, Stride& last, bool is_last) noexcept
{
    double gone = 0;
    for (uint32_t turn = 0;; ++turn) {
        if (!is_point_) faces_.see_from(proxy_.at);
        const auto [touching, gap] = faces_.touching(proxy_.at, touching_gap);
        const Projection<glm::dvec3> found =
            project(faces_.rows().first(touching), hand_, proxy_.at, distance_rounding);
        const double depth = glm::distance(found.at, hand_);
        if (depth == 0 ||
            gap > std::max(touching_gap, lifted * std::max(radius_, depth))) { // off again, or straight over an edge
            in_air_ = true;
            last = {};
            return {};
        }
        const Held held = as_rows(found);
        if (solid_) return {};
        const glm::dvec3 normal = (held.at - hand_) / depth, way = held.at - proxy_.at;
        const bool is_down = gap <= touching_gap;
        const glm::dvec3 down = is_down ? glm::dvec3(0) : glm::dot(way, normal) * normal, along = way - down;
        const double length = glm::length(along);
        std::optional<FrictionEllipse> ellipse;
        if (friction_.grain.is_there) [[unlikely]]
            ellipse.emplace(friction_.grain, normal);
        // Of its way, where the ellipse is a disc: in its direction friction bears so much more or less.
        const double eased = ellipse && length > 0 ? length / ellipse->size(along) : 1.0;
        if (const double left = length - eased * friction_.dynamic_coefficient * held.pushes();
            left < -distance_rounding && last.further != glm::dvec3(0)) { // it went too far: between there and here
            proxy_.at = last.from + last.left / (last.left - left) * last.further;
            last = {.went_back = true};
            pass();
            return held;
        }
        const double pressed = eased * held.pushes(),
                     rounding = std::max(distance_rounding, friction_settled * friction_.dynamic_coefficient * pressed);
        double share = share_past(friction_, length, pressed, rounding, proxy_.sliding);
        glm::dvec3 slip = share * along;
        if (ellipse && share > 0) {
            slip = along - ellipse->nearest(along, friction_.dynamic_coefficient * held.pushes());
            share = glm::length(slip) / length;
        }
        rests_ = share == 0 && is_down && turn == 0; // else planes are seen from elsewhere
        if (share == 0 && is_down) return held;
        const glm::dvec3 next = down + slip;
        const double left = step_max - gone;
        last.from = proxy_.at, last.left = share * length, last.went_back = false;
        glm::dvec3 step = turn == 0 && !is_point_ && !is_last && share > 0 ? further(held, next, last) : next;
        if (glm::length(step) > left) step = next, last.further = glm::dvec3(0);
        const double within = glm::length(step);
        if (within > left) step *= left / within;
        const double open = is_point_ ? open_share(faces_.rows(), proxy_.at, step, distance_rounding)
                                      : faces_.open(step, distance_rounding, {found.active.data(), found.count});
        proxy_.at += open * step;
        gone += open * std::min(within, left);
        pass();
        const bool whole = open == 1 && within <= left;
        if (!whole) last = {}; // the next step goes on with this one
        rests_ = whole && last.further == glm::dvec3(0) && stands(held);
        if (open == 1 || turn + 1 == turns_max) return held;
    }
}

} // namespace haptel::runtime
