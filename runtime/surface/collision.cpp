#include "runtime/surface/collision.h"

#include "runtime/surface/box_tree.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace haptel::runtime {

bool StartsOn::skips(uint32_t face, const Face& data) const
{
    const auto has = [&](uint32_t vertex) {
        return data.vertex[0] == vertex || data.vertex[1] == vertex || data.vertex[2] == vertex;
    };
    if (vertex0_ != none && has(vertex0_) && has(vertex1_)) return true;
    return std::find(faces_, faces_ + face_count_, face) != faces_ + face_count_;
}

// A ball that is somewhat smaller than it could be is found much sooner: of many triangles nearly equally far away few
// are looked at.
//
// A triangle is at least as far away as its plane and, in the plane, as each of its edges' lines beyond which the
// centre lies. Unlike the nearest point of a sliver this does not depend on which of its features is the nearest.
double clearance(const Surface& surface, const glm::dvec3& centre, double radius) noexcept
{
    constexpr double share = 0.6;
    double least = radius;
    const auto visit = [&](uint32_t face) {
        const auto corner = surface.corners(face);
        const glm::dvec3& n = surface.faces[face].normal;
        const double above = glm::dot(n, centre - corner[0]);
        double beyond = 0;
        for (uint32_t i = 0; i < 3; ++i) {
            const glm::dvec3 outward = glm::cross(corner[(i + 1) % 3] - corner[i], n);
            beyond = std::max(beyond, glm::dot(outward, centre - corner[i]) / glm::length(outward));
        }
        const double distance = std::sqrt(above * above + beyond * beyond) - 1; // one unit: rounding
        return least = std::min(least, std::max(0.0, share * distance));
    };
    surface.tree->ball(centre, radius, std::ref(visit));
    return least;
}

bool first_crossing(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to, const StartsOn& start,
                    Crossing& crossing, CollisionCount& count) noexcept
{
    ++count.sweeps;
    bool found = false;
    const auto visit = [&](uint32_t face) {
        ++count.triangles_tested;
        Crossing candidate;
        candidate.face = face;
        const auto [a, b, c] = surface.corners(face);
        if (!start.skips(face, surface.faces[face]) && crosses(from, to, a, b, c, candidate) &&
            (!found || earlier(candidate, crossing))) {
            found = true;
            crossing = candidate;
        }
        return found ? crossing.fraction() : 1.0;
    };
    surface.tree->segment(from, to, std::ref(visit));
    return found;
}

glm::dvec3 barycentric_of(const Surface& surface, uint32_t face, const glm::dvec3& point) noexcept
{
    const auto [a, b, c] = surface.corners(face);
    const glm::dvec3& n = surface.faces[face].normal;
    const double area_a = glm::dot(glm::cross(c - b, point - b), n), area_b = glm::dot(glm::cross(a - c, point - c), n),
                 area_c = glm::dot(glm::cross(b - a, point - a), n);
    const glm::dvec3 weights = glm::max(glm::dvec3(area_a, area_b, area_c), 0.0);
    const double sum = weights.x + weights.y + weights.z;
    return sum > 0 ? weights / sum : glm::dvec3(1, 0, 0);
}

glm::dvec3 crossing_point(const Surface& surface, const Crossing& crossing, const glm::dvec3& from,
                          const glm::dvec3& to) noexcept
{
    const Face& face = surface.faces[crossing.face];
    glm::dvec3 point = from + crossing.fraction() * (to - from);
    point -= glm::dot(point - surface.vertices[face.vertex[0]], face.normal) * face.normal;
    for (uint32_t i = 0; i < 3; ++i) {
        const glm::dvec3& a = surface.vertices[face.vertex[i]];
        const glm::dvec3 edge = surface.vertices[face.vertex[(i + 1) % 3]] - a;
        if (glm::dot(glm::cross(face.normal, edge), point - a) >= 0) continue;
        point = a + glm::clamp(glm::dot(point - a, edge) / glm::dot(edge, edge), 0.0, 1.0) * edge;
    }
    return point;
}

} // namespace haptel::runtime
