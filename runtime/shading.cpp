#include "runtime/shading.h"

namespace haptel::runtime {

namespace {

// Shorter than this the vertex normals cancel and the sum has no direction.
constexpr double least_length = 1e-6;

struct CornerNormals {
    glm::dvec3 n[3];
    CornerNormals(const Surface& surface, uint32_t face, uint32_t side)
    {
        for (int i = 0; i < 3; ++i) n[i] = surface.fans[surface.faces[face].fan[size_t(i)][side]].normal;
    }
    glm::dvec3 at(const glm::dvec3& w) const { return w.x * n[0] + w.y * n[1] + w.z * n[2]; }
};

} // namespace

glm::dvec3 shading_normal(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept
{
    const glm::dvec3 sum = CornerNormals(surface, face, side).at(barycentric);
    const double length = glm::length(sum);
    return length > least_length ? sum / length : surface.facet_normal(face, side);
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

    shading.normal = length > least_length ? sum / length : surface.facet_normal(face, side);
    for (int j = 0; j < 3; ++j) {
        if (length > least_length) {
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
