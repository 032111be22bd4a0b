#include "runtime/walls.h"

#include "runtime/predicates.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr double distance = 16; // of the proxy from a wall's plane; rounding is below 1

const glm::dvec3& corner(const Surface& surface, uint32_t face, uint32_t i)
{
    return surface.vertices[surface.faces[face].vertex[i]];
}

} // namespace

bool blocked(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to,
             Crossing& wall) noexcept
{
    const Face& data = surface.faces[face];
    bool found = false;
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        Crossing candidate;
        candidate.face = surface.pierced_by[k];
        if (!crosses(glm::round(from), glm::round(to), corner(surface, candidate.face, 0),
                     corner(surface, candidate.face, 1), corner(surface, candidate.face, 2), candidate))
            continue;
        if (!found || earlier(candidate, wall)) wall = candidate;
        found = true;
    }
    return found;
}

double share_before(const Surface& surface, const Crossing& wall, const glm::dvec3& way) noexcept
{
    const double toward = std::abs(glm::dot(way, surface.faces[wall.face].normal));
    return std::max(0.0, wall.fraction() - distance / toward);
}

glm::dvec3 along_crease(const Surface& surface, uint32_t face, const Crossing& wall, const glm::dvec3& way) noexcept
{
    const glm::dvec3 crease = glm::cross(surface.faces[face].normal, surface.faces[wall.face].normal);
    const double square = glm::dot(crease, crease);
    return square > 0 ? glm::dot(way, crease) / square * crease : glm::dvec3(0);
}

glm::dvec3 off_walls(const Surface& surface, const Crossing& landing, const glm::dvec3& from, const glm::dvec3& to,
                     const glm::dvec3& point) noexcept
{
    const Face& data = surface.faces[landing.face];
    glm::dvec3 moved = point;
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        const uint32_t wall = surface.pierced_by[k];
        const glm::dvec3 &a = corner(surface, wall, 0), &b = corner(surface, wall, 1), &c = corner(surface, wall, 2);
        // The way may have passed the wall's plane beside the wall.
        Crossing passing;
        passing.face = wall;
        const bool passed = crosses_plane(from, to, a, b, c, passing) && earlier(passing, landing);
        const glm::dvec3 normal = double(side_of_plane(a, b, c, passed ? to : from)) * surface.faces[wall].normal;
        const double away = glm::dot(moved - a, normal);
        const glm::dvec3 within = normal - glm::dot(normal, data.normal) * data.normal;
        const double square = glm::dot(within, within);
        // Nearly parallel sheets would push far; and far behind a wall's plane the wall is elsewhere.
        if (away < -distance || away >= distance || square < 1e-4) continue;
        moved += (distance - away) / square * within;
    }
    return moved;
}

} // namespace haptel::runtime
