#include "runtime/texture/shading.h"

#include "runtime/surface/corner.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

glm::dvec3 shading_normal(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept
{
    return shade(surface, face, side, barycentric, {false, false}).normal;
}

Shading shade(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric, Shaded what) noexcept
{
    Shading shading;
    const auto n = surface.shading_normals(face, side);
    const glm::dvec3 sum = barycentric.x * n[0] + barycentric.y * n[1] + barycentric.z * n[2];
    const double length = glm::length(sum);
    shading.normal = length > Surface::least_normal ? sum / length : surface.facet_normal(face, side);
    const bool turns = what.normal_dp && length > Surface::least_normal, drawn = what.uv && !surface.uv.empty();
    if (!turns && !drawn) return shading;

    // The weight of a corner grows by 1 over the altitude from its opposite edge; that of the first, as the others
    // lose.
    const auto [a, b, c] = surface.corners(face);
    const glm::dvec3 normal = surface.facet_normal(face);
    const glm::dvec3 from_ca = glm::cross(normal, a - c), from_ab = glm::cross(normal, b - a);
    const double per_m = 1 / (glm::dot(from_ab, c - a) * surface.lattice.unit_m);
    const glm::dvec3 second_dp = per_m * from_ca, third_dp = per_m * from_ab;

    if (turns) {
        // The part of a change across the normal, over the sum's length.
        const auto turn = [&](const glm::dvec3& change) {
            return (change - glm::dot(change, shading.normal) * shading.normal) / length;
        };
        shading.normal_dp =
            glm::outerProduct(turn(n[1] - n[0]), second_dp) + glm::outerProduct(turn(n[2] - n[0]), third_dp);
    }
    if (!drawn) return shading;
    const auto& of = surface.uv_of[face];
    const glm::dvec2 uv[] = {surface.uv[of[0]], surface.uv[of[1]], surface.uv[of[2]]};
    shading.uv_dp = glm::outerProduct(uv[1] - uv[0], second_dp) + glm::outerProduct(uv[2] - uv[0], third_dp);
    for (int i = 0; i < 3; ++i) shading.uv += uv[i] * barycentric[i];
    return shading;
}

UvFigures uv_figures(const Surface& surface)
{
    constexpr double slack = 1e-12; // a mean of corners may round past them
    UvFigures figures;
    for (int i = 0; i < 2; ++i) {
        figures.minimum[i] = figures.maximum[i] = figures.slope_max_per_m[i] = 0;
        for (int j = 0; j < 3; ++j) figures.dp_minimum[i][j] = figures.dp_maximum[i][j] = 0;
    }
    const auto take_in = [](double value, bool first, double& minimum, double& maximum) {
        minimum = first ? value : std::min(minimum, value);
        maximum = first ? value : std::max(maximum, value);
    };
    for (uint32_t face = 0; face < surface.uv_of.size(); ++face) {
        const bool first = face == 0;
        const glm::dmat3x2 uv_dp = shade(surface, face, 0, {1, 0, 0}).uv_dp; // the same all over the face
        for (int i = 0; i < 2; ++i) {
            for (size_t corner = 0; corner < 3; ++corner)
                take_in(surface.uv[surface.uv_of[face][corner]][i], first && corner == 0, figures.minimum[i],
                        figures.maximum[i]);
            for (int j = 0; j < 3; ++j) take_in(uv_dp[j][i], first, figures.dp_minimum[i][j], figures.dp_maximum[i][j]);
            const double slope = glm::length(glm::dvec3(uv_dp[0][i], uv_dp[1][i], uv_dp[2][i]));
            figures.slope_max_per_m[i] = std::max(figures.slope_max_per_m[i], slope * (1 + slack));
        }
    }
    for (int i = 0; i < 2; ++i) {
        const double margin = slack * std::max(std::abs(figures.minimum[i]), std::abs(figures.maximum[i]));
        figures.minimum[i] -= margin;
        figures.maximum[i] += margin;
    }
    return figures;
}

} // namespace haptel::runtime
