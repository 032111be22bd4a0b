#include "tests/runtime/meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace haptel::test {

using glm::dvec3;
using runtime::Mesh;

double bumpy_radius(const dvec3& d)
{
    return 1 + 0.02 * std::sin(7 * d.x + 1) * std::sin(9 * d.y) * std::sin(8 * d.z + 2) +
           0.02 * std::sin(11 * d.x * d.y + 3 * d.z);
}

Mesh make_bumpy_sphere(uint32_t subdivisions)
{
    Mesh mesh = runtime::make_icosphere(subdivisions);
    for (dvec3& p : mesh.positions_m) p = glm::normalize(p) * bumpy_radius(glm::normalize(p));
    return mesh;
}

Mesh make_star(uint32_t subdivisions)
{
    Mesh mesh = runtime::make_icosphere(subdivisions);
    std::mt19937 random(3);
    for (dvec3& p : mesh.positions_m) p = glm::normalize(p) * (0.3 + 0.7 * double(random()) / 4294967296.0);
    return mesh;
}

Mesh make_stairs()
{
    // Counter-clockwise; the caps are cut by hand from this profile, each triangle counter-clockwise.
    const std::vector<glm::dvec2> profile = {{0, 0}, {8, 0}, {8, 1}, {7, 1}, {7, 2}, {6, 2},
                                             {6, 3}, {5, 3}, {4, 1}, {3, 3}, {3, 4}, {0, 4}};
    const std::vector<std::array<uint32_t, 3>> cap = {{1, 2, 3}, {3, 4, 5}, {5, 6, 7}, {1, 3, 8},  {3, 5, 8},
                                                      {5, 7, 8}, {0, 1, 8}, {0, 8, 9}, {0, 9, 11}, {9, 10, 11}};
    const uint32_t n = uint32_t(profile.size()), levels = 4;
    Mesh mesh;
    for (uint32_t z = 0; z <= levels; ++z)
        for (const glm::dvec2& p : profile) mesh.positions_m.emplace_back(p, z);
    for (uint32_t z = 0; z < levels; ++z)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = z * n + i, b = z * n + (i + 1) % n;
            mesh.triangles.push_back({a, b, b + n});
            mesh.triangles.push_back({a, b + n, a + n});
        }
    for (const auto& [a, b, c] : cap) {
        mesh.triangles.push_back({a + levels * n, b + levels * n, c + levels * n});
        mesh.triangles.push_back({c, b, a});
    }
    return mesh;
}

Mesh make_touching_cubes(Touching touching)
{
    Mesh mesh;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            for (int z = 0; z < 3; ++z) {
                const bool even = (x + y + z) % 2 == 0, level = x % 2 == y % 2 && y % 2 == z % 2;
                if (touching == Touching::edges ? !even : !level) continue;
                const Mesh cube = runtime::make_box();
                const uint32_t first = uint32_t(mesh.positions_m.size());
                for (const dvec3& p : cube.positions_m) mesh.positions_m.push_back(p + dvec3(x, y, z));
                for (const auto& [a, b, c] : cube.triangles)
                    mesh.triangles.push_back({a + first, b + first, c + first});
            }
    return mesh;
}

Mesh make_crossing_boxes()
{
    Mesh mesh;
    for (int k = 0; k < 3; ++k) {
        const Mesh box = runtime::make_box({1, 0.6, 0.4});
        const double angle = 0.7 * k + 0.1;
        const uint32_t first = uint32_t(mesh.positions_m.size());
        for (const dvec3& p : box.positions_m)
            mesh.positions_m.emplace_back(p.x * std::cos(angle) - p.y * std::sin(angle),
                                          p.x * std::sin(angle) + p.y * std::cos(angle), p.z + 0.15 * k);
        for (const auto& [a, b, c] : box.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
    }
    return mesh;
}

std::shared_ptr<const runtime::Surface> surface_of(const Mesh& mesh)
{
    runtime::SurfaceResult result = runtime::build_surface(mesh);
    if (!result.surface) throw std::runtime_error(result.error);
    return result.surface;
}

Winding winding(const runtime::Surface& surface, const dvec3& point_m)
{
    Winding result{0, INFINITY};
    for (uint32_t f = 0; f < surface.faces.size(); ++f) {
        const dvec3 a = surface.vertex_m(f, 0) - point_m, b = surface.vertex_m(f, 1) - point_m,
                    c = surface.vertex_m(f, 2) - point_m;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        result.number += std::atan2(glm::dot(a, glm::cross(b, c)),
                                    la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb) /
                         (2 * std::numbers::pi);

        const dvec3 n = glm::normalize(glm::cross(b - a, c - a)), foot = glm::dot(a, n) * n;
        const auto inside = [&](const dvec3& from, const dvec3& to) {
            return glm::dot(glm::cross(n, to - from), foot - from) >= 0;
        };
        const auto to_edge = [](const dvec3& from, const dvec3& to) {
            const dvec3 e = to - from;
            return glm::length(from + glm::clamp(-glm::dot(from, e) / glm::dot(e, e), 0.0, 1.0) * e);
        };
        const bool over = inside(a, b) && inside(b, c) && inside(c, a);
        result.distance_m = std::min(result.distance_m, over ? glm::length(foot)
                                                             : std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)}));
    }
    return result;
}

} // namespace haptel::test
