#include "runtime/surface/facet_lines.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

using glm::cross;
using glm::dot;
using glm::dvec3;

// Normals differ by rounding alone.
constexpr double same_normal = 1e-12;

} // namespace

FacetLines::FacetLines(const Surface& surface, uint32_t of_face, uint32_t of_side) noexcept
    : face(of_face), side(of_side), bubble(0)
{
    const auto& of_corner = surface.faces[face].fan_or_part;
    for (uint32_t i = 0; i < 3; ++i) {
        p[i] = surface.vertex_m(face, i);
        n[i] = surface.shading_normal(of_corner[i][side]);
        const Roundness round = surface.roundness_of(of_corner[i][side]);
        sunk_m[i] = round.raised_m;
        upright[i] = std::isfinite(round.bent_in_per_m);
        bent_in_per_m[i] = upright[i] > 0 ? round.bent_in_per_m : 0;
        bent_out_per_m[i] = round.bent_out_per_m;
    }
    for (uint32_t i = 0; i < 3; ++i) {
        const dvec3 edge = p[next(i)] - p[i];
        rise[i] = -dot(n[i], edge);
        back[i] = dot(n[next(i)], edge);
        bubble += 0.5 * (rise[i] + back[i]); // so that what is quadratic is met
    }
    for (uint32_t i = 0; i < 3; ++i) { // what the rest lacks there, from the middle of the edge to the third corner
        const uint32_t j = next(i), k = previous(i);
        const double ends = rise[i] + back[i], sides = rise[j] + back[k], length = glm::length(n[i] + n[j]);
        const double has = 0.25 * (sides + bubble) - 0.375 * ends;
        across[i] = length > Surface::least_normal ? 16 * ((sides - 0.5 * ends) / length - has) : 0;
    }
    const dvec3 facet_normal = surface.facet_normal(face, side);
    flat =
        std::all_of(n, n + 3, [&](const dvec3& normal) { return glm::distance(normal, facet_normal) < same_normal; });
    for (uint32_t i : {1u, 2u}) p[i] -= p[0], n[i] -= n[0];
    area = cross(p[1], p[2]);
    turn = cross(p[1], n[2]) + cross(n[1], p[2]);
    turn_dt = cross(n[1], n[2]);
    const dvec3* const by_t[] = {&area, &turn, &turn_dt};
    for (uint32_t i = 0; i < 3; ++i) by_normal[i] = dot(n[0], *by_t[i]), by_area[i] = dot(area, *by_t[i]);
    const double size_m2 = glm::length(area);
    per_m2 = (side ? -1 : 1) / size_m2;
    edge_m = std::sqrt(size_m2);
}

} // namespace haptel::runtime
