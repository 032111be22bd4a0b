#include "tests/anchors/geodesic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace haptel::test {

using glm::dvec3;
using runtime::Mesh;

Mesh make_geodesic(uint32_t parts)
{
    const double g = (1 + std::sqrt(5.0)) / 2;
    const std::array<dvec3, 12> corner = {{{-1, g, 0},
                                           {1, g, 0},
                                           {-1, -g, 0},
                                           {1, -g, 0},
                                           {0, -1, g},
                                           {0, 1, g},
                                           {0, -1, -g},
                                           {0, 1, -g},
                                           {g, 0, -1},
                                           {g, 0, 1},
                                           {-g, 0, -1},
                                           {-g, 0, 1}}};
    static constexpr uint32_t faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    Mesh mesh;
    // A vertex is its weights of the corners: those on edges and corners are shared by more than one face.
    using Weights = std::vector<std::pair<uint32_t, uint32_t>>;
    std::map<Weights, uint32_t> shared;
    for (const auto& face : faces) {
        const auto vertex = [&](uint32_t i, uint32_t j) { // i parts toward the second corner, j toward the third
            Weights weights;
            for (const auto& [which, weight] : {std::pair{face[0], parts - i - j}, {face[1], i}, {face[2], j}})
                if (weight > 0) weights.emplace_back(which, weight);
            std::sort(weights.begin(), weights.end());
            dvec3 place(0);
            for (const auto& [which, weight] : weights) place += double(weight) * corner[which];
            const auto next = uint32_t(mesh.positions_m.size());
            if (weights.size() < 3) {
                const auto [known, is_new] = shared.try_emplace(weights, next);
                if (!is_new) return known->second;
            }
            mesh.positions_m.push_back(glm::normalize(place));
            return next;
        };
        std::vector<uint32_t> row;
        for (uint32_t j = 0; j <= parts; ++j) {
            std::vector<uint32_t> next;
            for (uint32_t i = 0; i + j <= parts; ++i) next.push_back(vertex(i, j));
            for (uint32_t i = 0; i < next.size() && j > 0; ++i) {
                mesh.triangles.push_back({row[i], row[i + 1], next[i]});
                if (i + 1 < next.size()) mesh.triangles.push_back({row[i + 1], next[i + 1], next[i]});
            }
            row = std::move(next);
        }
    }
    return mesh;
}

namespace {

constexpr double bump_m = 0.02, wave = 8;

// Gradient of |p| - radius(p / |p|), which is 0 on the surface: its normal, not of unit length.
dvec3 outward(const dvec3& p)
{
    const double length = glm::length(p);
    const dvec3 d = p / length, s(std::sin(wave * d.x), std::sin(wave * d.y), std::sin(wave * d.z)),
                c(std::cos(wave * d.x), std::cos(wave * d.y), std::cos(wave * d.z));
    const dvec3 by_direction = bump_m * wave * dvec3(c.x * s.y * s.z, s.x * c.y * s.z, s.x * s.y * c.z);
    return d - (by_direction - glm::dot(by_direction, d) * d) / length;
}

} // namespace

double BumpySphere::radius_m(const dvec3& d)
{
    return 1 + bump_m * std::sin(wave * d.x) * std::sin(wave * d.y) * std::sin(wave * d.z);
}

dvec3 BumpySphere::nearest_m(const dvec3& point_m)
{
    const auto onto = [](const dvec3& p) { return glm::normalize(p) * radius_m(glm::normalize(p)); };
    dvec3 foot = onto(point_m);
    for (int i = 0; i < 40; ++i) { // each round errs by distance over radius of curvature times what the last one did
        const dvec3 normal = glm::normalize(outward(foot)), to = point_m - foot;
        const dvec3 along = to - glm::dot(to, normal) * normal;
        foot = onto(foot + along);
        if (glm::dot(along, along) < 1e-24) break;
    }
    return foot;
}

Mesh BumpySphere::mesh(uint32_t parts)
{
    Mesh mesh = make_geodesic(parts);
    for (dvec3& p : mesh.positions_m) p *= radius_m(p);
    return mesh;
}

} // namespace haptel::test
