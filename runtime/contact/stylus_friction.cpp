#include "runtime/contact/stylus_friction.h"

#include "runtime/geometry/lattice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

// Less than any lever leaves: where an end cannot move at all, rounding must not choose its friction.
constexpr double least_give = 1e-9;

// An end that is jammed between a face and an edge would bear whatever the lever of the shaft makes of the hand. Where
// that would be aimed at beyond the workspace it slips: the walk could not follow.
constexpr double deepest = Lattice::workspace - Lattice::extent;

} // namespace

void EndFriction::take_hold(bool of_sides) noexcept
{
    if (!touches) lag = glm::dvec3(0);
    sticks = of_sides && drags() && !slips;
    limit_before_ = limit_;
    if (drags()) ellipse = FrictionEllipse(friction.grain, normal);
}

double EndFriction::follow(const glm::dvec3& aim, const glm::dvec3& held, const glm::dmat3& give) noexcept
{
    const double height = glm::dot(normal, at - aim);
    const double found = coefficient() * bears * glm::clamp(height - unfelt, 0.0, deepest);
    if (sticks) {
        lag = at - aim - height * normal;
        if (ellipse.size(lag) <= found && height <= deepest) return 0;
        lag = glm::dvec3(0);
        sticks = false;
        slips = slides = true;
        limit_ = limit_before_ = coefficient() * bears * glm::clamp(height - unfelt, 0.0, deepest);
        return HUGE_VAL;
    }
    const glm::dvec3 before = lag;
    const double most = limited(found);
    const bool moved = std::exchange(moves, oppose(held - at - give * lag, give, most));
    if (moves != moved) return HUGE_VAL;
    const double change = std::max(glm::distance(lag, before), std::fabs(most - found));
    return change == 0 ? 0 : change / most;
}

// The limit to try next. Where more friction makes the sides press the end less, taking what was found would swing to
// and fro: a secant goes between.
double EndFriction::limited(double found) noexcept
{
    const double step = limit_ - limit_before_, slope = step != 0 ? (found - found_before_) / step : 0.0;
    const double next = std::max(0.0, limit_ + (found - limit_) / (1 - std::min(0.0, slope)));
    limit_before_ = std::exchange(limit_, next);
    found_before_ = found;
    return limit_;
}

// The lag of an end that without friction would go by `way`. Of the disc of all that are no longer than `most`, or of
// the ellipse, it is the one where the quadratic form lag . give lag / 2 + way . lag is least: there way + give lag is
// 0 inside, and on the edge it points inward at a right angle to that, so that an end slips against its friction or not
// at all. Where there is a grain the plane is stretched so that the ellipse is a disc. Returns whether the end slips.
bool EndFriction::oppose(const glm::dvec3& way, const glm::dmat3& give, double most) noexcept
{
    lag = glm::dvec3(0);
    if (!(most > 0)) return true;
    const glm::dvec3 &u = ellipse.half_axis(0), &v = ellipse.half_axis(1);
    const double uu = glm::dot(u, give * u), uv = glm::dot(u, give * v), vv = glm::dot(v, give * v);
    const double half = 0.5 * (uu - vv), root = std::sqrt(half * half + uv * uv);
    glm::dvec2 first(1, 0);
    if (root > 0) first = glm::normalize(half > 0 ? glm::dvec2(half + root, uv) : glm::dvec2(uv, root - half));
    const glm::dvec3 axis[2] = {first.x * u + first.y * v, first.x * v - first.y * u};
    const double gives[2] = {std::max(least_give, 0.5 * (uu + vv) + root),
                             std::max(least_give, 0.5 * (uu + vv) - root)};
    const double ways[2] = {glm::dot(way, axis[0]), glm::dot(way, axis[1])};
    double along[2];
    const double slip = least_in_disc(gives, ways, most, along);
    lag = along[0] * axis[0] + along[1] * axis[1];
    return slip > 0;
}

} // namespace haptel::runtime
