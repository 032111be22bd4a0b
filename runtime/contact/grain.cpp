#include "runtime/contact/grain.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr int newton_steps_max = 24;
constexpr double edge_slack = 1e-12; // of the disc's radius

// Of a direction's length: what of it lies in the plane, and is no more than rounding makes of one along the normal.
constexpr double along_normal = 1e-9;

glm::dvec3 times(const Grain& grain, const glm::dvec3& v)
{
    const glm::dvec3 &d = grain.diagonal, &m = grain.mixed;
    return {d.x * v.x + m.z * v.y + m.y * v.z, m.z * v.x + d.y * v.y + m.x * v.z, m.y * v.x + m.x * v.y + d.z * v.z};
}

} // namespace

Grain grain_along(const glm::dvec3& direction, double scale, const glm::dvec3& normal) noexcept
{
    const glm::dvec3 sizes = glm::abs(direction);
    const double largest = std::max({sizes.x, sizes.y, sizes.z});
    if (!(largest > 0 && std::isfinite(largest + sizes.x + sizes.y + sizes.z) && std::isfinite(scale))) return {};
    const glm::dvec3 unscaled = direction / largest; // squares of it neither vanish nor overflow
    const glm::dvec3 within = unscaled - glm::dot(unscaled, normal) * normal;
    const double length = glm::length(within);
    if (!(length > along_normal * glm::length(unscaled))) return {};
    const glm::dvec3 e = within / length;
    const double more = std::clamp(scale, least_grain, most_grain) - 1;
    if (more == 0) return {};
    return {true, more * e * e, more * glm::dvec3(e.y * e.z, e.z * e.x, e.x * e.y)};
}

Grain mixed(const Grain& from, const Grain& to, double share) noexcept
{
    if (!from.is_there && !to.is_there) return {};
    return {true, from.diagonal + share * (to.diagonal - from.diagonal), from.mixed + share * (to.mixed - from.mixed)};
}

Grain turned(const Grain& grain, const glm::dmat3& rotation) noexcept
{
    const glm::dmat3 back = glm::transpose(rotation);
    glm::dmat3 columns;
    for (int i = 0; i < 3; ++i) columns[i] = rotation * times(grain, back[i]);
    return {grain.is_there, {columns[0].x, columns[1].y, columns[2].z}, {columns[1].z, columns[2].x, columns[0].y}};
}

FrictionEllipse::FrictionEllipse(const Grain& grain, const glm::dvec3& normal) noexcept
{
    const glm::dvec3 off = std::fabs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(normal, off)), v = glm::cross(normal, u);
    const glm::dvec3 of_u = times(grain, u), of_v = times(grain, v);
    const double uu = glm::dot(u, of_u), uv = glm::dot(u, of_v), vv = glm::dot(v, of_v);
    const double half = 0.5 * (uu - vv), root = std::sqrt(half * half + uv * uv);
    axis_[0] = u;
    if (root > 0) axis_[0] = glm::normalize(half > 0 ? (half + root) * u + uv * v : uv * u + (root - half) * v);
    axis_[1] = glm::cross(normal, axis_[0]);
    scale_[0] = std::clamp(1 + 0.5 * (uu + vv) + root, least_grain, most_grain);
    scale_[1] = std::clamp(1 + 0.5 * (uu + vv) - root, least_grain, most_grain);
    for (int i = 0; i < 2; ++i) half_[i] = scale_[i] * axis_[i];
}

glm::dvec3 FrictionEllipse::as_in_disc(const glm::dvec3& v) const noexcept
{
    return glm::dot(v, axis_[0]) / scale_[0] * axis_[0] + glm::dot(v, axis_[1]) / scale_[1] * axis_[1];
}

glm::dvec3 FrictionEllipse::nearest(const glm::dvec3& v, double most) const noexcept
{
    double gives[2], ways[2], m[2];
    for (int i = 0; i < 2; ++i) {
        gives[i] = scale_[i] * scale_[i];
        ways[i] = -glm::dot(v, half_[i]);
    }
    least_in_disc(gives, ways, most, m);
    return m[0] * half_[0] + m[1] * half_[1];
}

// Along the axes of the form one equation for the multiplier is left, solved as in More and Sorensen 1983, Computing a
// trust region step, algorithm 3.2.
double least_in_disc(const double (&gives)[2], const double (&ways)[2], double most, double (&m)[2]) noexcept
{
    m[0] = m[1] = 0;
    if (!(most > 0)) return 0;
    // At most what it will be, and just that where both axes give alike.
    double multiplier =
        std::max(0.0, std::sqrt(ways[0] * ways[0] + ways[1] * ways[1]) / most - std::max(gives[0], gives[1]));
    for (int i = 0; i < 2; ++i) multiplier = std::max(multiplier, std::fabs(ways[i]) / most - gives[i]);
    for (int step = 0; step < newton_steps_max; ++step) {
        double square = 0, slope = 0;
        for (int i = 0; i < 2; ++i) {
            m[i] = 0;
            if (ways[i] == 0) continue;
            m[i] = -ways[i] / (gives[i] + multiplier);
            square += m[i] * m[i];
            slope += m[i] * m[i] / (gives[i] + multiplier);
        }
        const double length = std::sqrt(square);
        if (!(length > (1 + edge_slack) * most)) break;
        multiplier += square / slope * (length / most - 1);
    }
    return multiplier;
}

} // namespace haptel::runtime
