#include "runtime/surface/corner.h"

#include <cmath>

namespace haptel::runtime {

bool NearestInFan::consider(const Surface& surface, const Sector& start, const glm::dvec3& to) noexcept
{
    return for_each_sector(surface, start, [&](const Sector& candidate) {
        const auto offer = [&](double candidate_way, const glm::dvec3& across, uint32_t candidate_edge) {
            const double square = glm::dot(across, across);
            if (!(candidate_way > 0) || square >= across_square) return;
            across_square = square;
            way = candidate_way;
            sector = candidate;
            edge = candidate_edge;
        };
        const auto offer_edge = [&](const glm::dvec3& leading, uint32_t candidate_edge) {
            const glm::dvec3 along = glm::normalize(leading);
            const double candidate_way = glm::dot(to, along);
            offer(candidate_way, to - candidate_way * along, candidate_edge);
        };
        const Face& face = surface.faces[candidate.face];
        const auto [leaving, arriving] = Spokes(surface, candidate);
        const glm::dvec3 across = glm::dot(to, face.normal) * face.normal, in_plane = to - across;
        if (glm::dot(in_plane, glm::cross(face.normal, leaving)) >= 0 &&
            glm::dot(in_plane, glm::cross(arriving, face.normal)) >= 0)
            offer(glm::length(in_plane), across, into_sector);
        offer_edge(leaving, candidate.corner);
        offer_edge(arriving, previous(candidate.corner));
    });
}

Feature feature_at(const glm::dvec3& barycentric) noexcept
{
    constexpr double on_feature = 1e-9; // of a corner's weight
    for (uint32_t i = 0; i < 3; ++i)
        if (barycentric[int(i)] > 1 - on_feature) return {Feature::On::vertex, i};
    for (uint32_t i = 0; i < 3; ++i)
        if (barycentric[int(previous(i))] <= on_feature) return {Feature::On::edge, i};
    return {};
}

bool on_crease(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept
{
    const auto [on, i] = feature_at(barycentric);
    if (on == Feature::On::face) return false;
    if (on == Feature::On::vertex) return (surface.faces[face].fan_or_part[i][side] & Surface::is_part) != 0;
    return !smooth_neighbour(surface, {face, i, side}, i) || !smooth_neighbour(surface, {face, next(i), side}, i);
}

FanOutward::FanOutward(const Surface& surface, const Sector& start) noexcept
{
    closed = for_each_sector(surface, start, [&](const Sector& sector) {
        const auto [a, b] = Spokes(surface, sector);
        normal +=
            std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * surface.facet_normal(sector.face, sector.side);
    });
}

} // namespace haptel::runtime
