#include "runtime/surface/build/meeting.h"

#include "runtime/surface/corner.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// Edges reach farther than faces, so that no place lies between being on one and being on the other.
constexpr double of_edges = 1.5;

// The middle of where two lines come nearest to each other, between their ends. False: not there, or not so near.
bool cross_at(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b, double tolerance,
              glm::dvec3& at)
{
    const glm::dvec3 one = q - p, other = b - a, between = a - p;
    const double pp = glm::dot(one, one), qq = glm::dot(other, other), pq = glm::dot(one, other);
    const double square = pp * qq - pq * pq;
    if (square <= 1e-12 * pp * qq) return false; // parallel: they meet in their ends, if at all
    const double s = (glm::dot(between, one) * qq - glm::dot(between, other) * pq) / square;
    const double t = (glm::dot(between, one) * pq - glm::dot(between, other) * pp) / square;
    if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return false;
    const glm::dvec3 here = p + s * one, there = a + t * other;
    at = 0.5 * here + 0.5 * there;
    return glm::distance(here, there) <= tolerance;
}

} // namespace

bool is_beside(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, double tolerance) noexcept
{
    const glm::dvec3 along = b - a;
    const double square = glm::dot(along, along), share = glm::dot(p - a, along) / square;
    return share > 0 && share < 1 && glm::length(p - a - share * along) <= tolerance;
}

Meeting meeting_of(const std::vector<glm::dvec3>& vertices, const std::array<uint32_t, 2>& edge,
                   const std::array<uint32_t, 3>& face, double tolerance) noexcept
{
    using Of = Meeting::Of;
    const glm::dvec3 ends[2] = {vertices[edge[0]], vertices[edge[1]]};
    const glm::dvec3 corners[3] = {vertices[face[0]], vertices[face[1]], vertices[face[2]]};
    const auto is_corner = [&](uint32_t vertex) { return std::find(face.begin(), face.end(), vertex) != face.end(); };
    const bool shared[2] = {is_corner(edge[0]), is_corner(edge[1])};

    const glm::dvec3 area = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double twice = glm::length(area);
    if (twice == 0 || ends[0] == ends[1]) return {};
    const glm::dvec3 normal = area / twice;
    double height[2];
    for (uint32_t end = 0; end < 2; ++end) height[end] = glm::dot(ends[end] - corners[0], normal);
    const double apart = corners_reach * tolerance;
    if (std::min(height[0], height[1]) > apart || std::max(height[0], height[1]) < -apart) return {};

    for (uint32_t end = 0; end < 2; ++end)
        for (uint32_t i = 0; i < 3 && !shared[end]; ++i)
            if (face[i] != edge[1 - end] && glm::distance(ends[end], corners[i]) <= apart)
                return {Of::corners, end, i, {}};
    for (uint32_t end = 0; end < 2; ++end)
        for (uint32_t i = 0; i < 3 && !shared[end]; ++i)
            if (is_beside(ends[end], corners[i], corners[next(i)], of_edges * tolerance))
                return {Of::corner_and_edge, end, i, {}};
    for (uint32_t i = 0; i < 3; ++i)
        if (face[i] != edge[0] && face[i] != edge[1] && is_beside(corners[i], ends[0], ends[1], of_edges * tolerance))
            return {Of::edge_and_corner, 0, i, {}};

    const auto within = [&](const glm::dvec3& p) {
        for (uint32_t i = 0; i < 3; ++i)
            if (glm::dot(glm::cross(normal, corners[next(i)] - corners[i]), p - corners[i]) <= 0) return false;
        return true;
    };
    for (uint32_t end = 0; end < 2; ++end)
        if (!shared[end] && std::abs(height[end]) <= tolerance && within(ends[end]))
            return {Of::corner_and_face, end, 0, {}};
    // Where they cross beside a corner or an end it is that which meets.
    const auto crossing = [&](const Meeting& meeting, Of of_end) {
        for (uint32_t i = 0; i < 3; ++i)
            if (face[i] != edge[0] && face[i] != edge[1] && glm::distance(meeting.at, corners[i]) <= apart)
                return Meeting{Of::edge_and_corner, 0, i, {}};
        for (uint32_t end = 0; end < 2; ++end)
            if (!shared[end] && glm::distance(meeting.at, ends[end]) <= apart)
                return Meeting{of_end, end, meeting.index, {}};
        return meeting;
    };
    for (uint32_t i = 0; i < 3; ++i) {
        const auto has = [&](uint32_t vertex) { return face[i] == vertex || face[next(i)] == vertex; };
        glm::dvec3 at;
        if (!has(edge[0]) && !has(edge[1]) && cross_at(ends[0], ends[1], corners[i], corners[next(i)], tolerance, at))
            return crossing({Of::edges, 0, i, at}, Of::corner_and_edge);
    }
    if (shared[0] || shared[1] || (height[0] < 0) == (height[1] < 0)) return {};
    const glm::dvec3 at = ends[0] + height[0] / (height[0] - height[1]) * (ends[1] - ends[0]);
    return within(at) ? crossing({Of::edge_and_face, 0, 0, at}, Of::corner_and_face) : Meeting{};
}

} // namespace haptel::runtime
