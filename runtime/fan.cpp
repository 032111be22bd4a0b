#include "runtime/fan.h"

namespace haptel::runtime {

bool NearestInFan::consider(const Surface& surface, const Sector& start, const glm::dvec3& to) noexcept
{
    return for_each_sector(surface, start, [&](const Sector& candidate) {
        const auto offer = [&](double candidate_way, uint32_t candidate_edge) {
            if (candidate_way <= way) return;
            way = candidate_way;
            sector = candidate;
            edge = candidate_edge;
        };
        const Face& face = surface.faces[candidate.face];
        const glm::dvec3& at = surface.vertices[face.vertex[candidate.corner]];
        const glm::dvec3 leaving = surface.vertices[face.vertex[next(candidate.corner)]] - at;
        const glm::dvec3 arriving = surface.vertices[face.vertex[previous(candidate.corner)]] - at;
        const glm::dvec3 in_plane = to - glm::dot(to, face.normal) * face.normal;
        if (glm::dot(in_plane, glm::cross(face.normal, leaving)) >= 0 &&
            glm::dot(in_plane, glm::cross(arriving, face.normal)) >= 0)
            offer(glm::length(in_plane), into_sector);
        offer(glm::dot(to, leaving) / glm::length(leaving), candidate.corner);
        offer(glm::dot(to, arriving) / glm::length(arriving), previous(candidate.corner));
    });
}

} // namespace haptel::runtime
