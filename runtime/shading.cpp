#include "runtime/shading.h"

#include "runtime/fan.h"

#include <algorithm>
#include <cmath>

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

Shading shade(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric, Shaded what) noexcept
{
    Shading shading;
    const CornerNormals corners(surface, face, side);
    const glm::dvec3 sum = corners.at(barycentric);
    const double length = glm::length(sum);
    shading.normal = length > Surface::least_normal ? sum / length : surface.facet_normal(face, side);
    const bool turns = what.normal_dp && length > Surface::least_normal, drawn = what.uv && !surface.uv.empty();
    if (!turns && !drawn) return shading;

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

    for (int j = 0; j < 3; ++j) {
        if (turns) {
            glm::dvec3 change{0};
            for (int i = 0; i < 3; ++i) change += corners.n[i] * weight_dp[i][j];
            shading.normal_dp[j] = (change - glm::dot(change, shading.normal) * shading.normal) / length;
        }
        if (drawn)
            for (int i = 0; i < 3; ++i) shading.uv_dp[j] += surface.uv[face][size_t(i)] * weight_dp[i][j];
    }
    if (drawn)
        for (int i = 0; i < 3; ++i) shading.uv += surface.uv[face][size_t(i)] * barycentric[i];
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
    for (uint32_t face = 0; face < surface.uv.size(); ++face) {
        const bool first = face == 0;
        const glm::dmat3x2 uv_dp = shade(surface, face, 0, {1, 0, 0}).uv_dp; // the same all over the face
        for (int i = 0; i < 2; ++i) {
            for (size_t corner = 0; corner < 3; ++corner)
                take_in(surface.uv[face][corner][i], first && corner == 0, figures.minimum[i], figures.maximum[i]);
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
