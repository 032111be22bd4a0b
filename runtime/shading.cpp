#include "runtime/shading.h"

#include "runtime/fan.h"

namespace haptel::runtime {

namespace {

struct CornerNormals {
    glm::dvec3 n[3];
    CornerNormals(const Surface& surface, uint32_t face, uint32_t side)
    {
        const auto& of_corner = surface.shading_normal_of[face];
        for (size_t i = 0; i < 3; ++i) n[i] = surface.shading_normals[of_corner[i][side]].normal;
    }
    glm::dvec3 at(const glm::dvec3& w) const { return w.x * n[0] + w.y * n[1] + w.z * n[2]; }
};

} // namespace

glm::dvec3 shading_normal(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept
{
    const glm::dvec3 sum = CornerNormals(surface, face, side).at(barycentric);
    const double length = glm::length(sum);
    return length > Surface::least_normal ? sum / length : surface.facet_normal(face, side);
}

bool on_crease(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept
{
    constexpr double on_feature = 1e-9; // of a corner's weight, which is 0 there but for rounding
    const auto& of_corner = surface.shading_normal_of[face];
    for (uint32_t i = 0; i < 3; ++i)
        if (barycentric[int(i)] > 1 - on_feature) return !surface.shading_normals[of_corner[i][side]].whole;
    for (uint32_t i = 0; i < 3; ++i) {
        if (barycentric[int(previous(i))] > on_feature) continue;
        const SideEdge link = surface.faces[face].link[i][side];
        if (link.face() == face) return false; // a border: nothing meets the face there
        const auto& there = surface.shading_normal_of[link.face()];
        const bool same_way = surface.faces[link.face()].vertex[link.edge()] == surface.faces[face].vertex[i];
        const uint32_t first = same_way ? link.edge() : next(link.edge());
        const uint32_t second = same_way ? next(link.edge()) : link.edge();
        return of_corner[i][side] != there[first][link.side()] ||
               of_corner[next(i)][side] != there[second][link.side()];
    }
    return false;
}

Shading shade(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept
{
    Shading shading;
    const CornerNormals corners(surface, face, side);
    const glm::dvec3 sum = corners.at(barycentric);
    const double length = glm::length(sum);

    // The weight of corner i grows by 1 over the altitude from its opposite edge.
    glm::dvec3 weight_dp[3];
    const glm::dvec3 normal = surface.facet_normal(face);
    const auto& v = surface.faces[face].vertex;
    for (uint32_t i = 0; i < 3; ++i) {
        const glm::dvec3& from = surface.vertices[v[(i + 1) % 3]];
        const glm::dvec3 inward = glm::cross(normal, surface.vertices[v[(i + 2) % 3]] - from);
        const double twice_area = glm::dot(inward, surface.vertices[v[i]] - from);
        weight_dp[i] = inward / (twice_area * surface.lattice.unit_m);
    }

    shading.normal = length > Surface::least_normal ? sum / length : surface.facet_normal(face, side);
    for (int j = 0; j < 3; ++j) {
        if (length > Surface::least_normal) {
            glm::dvec3 change{0};
            for (int i = 0; i < 3; ++i) change += corners.n[i] * weight_dp[i][j];
            shading.normal_dp[j] = (change - glm::dot(change, shading.normal) * shading.normal) / length;
        }
        if (!surface.uv.empty())
            for (int i = 0; i < 3; ++i) shading.uv_dp[j] += surface.uv[face][size_t(i)] * weight_dp[i][j];
    }
    if (!surface.uv.empty())
        for (int i = 0; i < 3; ++i) shading.uv += surface.uv[face][size_t(i)] * barycentric[i];
    return shading;
}

} // namespace haptel::runtime
