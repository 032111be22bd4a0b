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
        const glm::dvec3& at = surface.vertices[face.vertex[candidate.corner]];
        const glm::dvec3 leaving = surface.vertices[face.vertex[next(candidate.corner)]] - at;
        const glm::dvec3 arriving = surface.vertices[face.vertex[previous(candidate.corner)]] - at;
        const glm::dvec3 across = glm::dot(to, face.normal) * face.normal, in_plane = to - across;
        if (glm::dot(in_plane, glm::cross(face.normal, leaving)) >= 0 &&
            glm::dot(in_plane, glm::cross(arriving, face.normal)) >= 0)
            offer(glm::length(in_plane), across, into_sector);
        offer_edge(leaving, candidate.corner);
        offer_edge(arriving, previous(candidate.corner));
    });
}

glm::dvec3 weighted_normal(const Surface& surface, const Sector& sector) noexcept
{
    const Face& face = surface.faces[sector.face];
    const glm::dvec3& at = surface.vertices[face.vertex[sector.corner]];
    const glm::dvec3 a = surface.vertices[face.vertex[next(sector.corner)]] - at;
    const glm::dvec3 b = surface.vertices[face.vertex[previous(sector.corner)]] - at;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * surface.facet_normal(sector.face, sector.side);
}

} // namespace haptel::runtime
