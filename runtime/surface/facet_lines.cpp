#include "runtime/surface/facet_lines.h"

#include "runtime/surface/corner.h"
#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace haptel::runtime {

namespace {

using glm::cross;
using glm::dot;
using glm::dvec3;

// Normals differ by rounding alone.
constexpr double same_normal = 1e-12;

// Cosine between a corner's normal and a facet: a spring along lines that slant more would be more than 1.6 times as
// hard as along the facet's normal.
constexpr double least_upright = 0.8;

// The most of s is found at places of so fine a grid, and lies up to so much above.
constexpr int grid = 6;
constexpr double between_places = 1.02;

float as_float_above(double value)
{
    return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

struct OfFacet {
    Roundness round;
    bool upright[3];
};

OfFacet roundness_of(const Surface& surface, uint32_t face, uint32_t side)
{
    const FacetLines lines(surface, face, side);
    OfFacet found{};
    if (lines.flat) {
        std::fill_n(found.upright, 3, true);
        return found;
    }
    double most = 0;
    for (int i = 0; i <= grid; ++i)
        for (int j = 0; j + i <= grid; ++j)
            most = std::max(most, lines.raised(dvec3(grid - i - j, i, j) / double(grid)).m);
    found.round.raised_m = as_float_above(between_places * most);

    // The normal's derivative in the plane of the facet, its symmetric part.
    const dvec3 x = glm::normalize(lines.p[1]), y = glm::normalize(cross(lines.area, x));
    const double length = dot(lines.p[1], x), place = dot(lines.p[2], x), height = dot(lines.p[2], y);
    const dvec3 by_x = lines.n[1] / length, by_y = (lines.n[2] - place * by_x) / height;
    const double xx = dot(by_x, x), yy = dot(by_y, y), xy = 0.5 * (dot(by_x, y) + dot(by_y, x));
    const double mean = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy);
    found.round.bent_in_per_m = as_float_above(std::max(0.0, mean + apart));
    found.round.bent_out_per_m = as_float_above(std::max(0.0, apart - mean));
    const dvec3 facet_normal = surface.facet_normal(face, side);
    for (int i = 0; i < 3; ++i)
        found.upright[i] = dot(facet_normal, i ? lines.n[0] + lines.n[i] : lines.n[0]) > least_upright;
    return found;
}

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
    across[0] = across[1] = across[2] = 0;
    double lacks[3] = {};
    for (uint32_t i = 0; i < 3; ++i) { // what the cubic lacks, from the middle of an edge to the third corner
        const uint32_t j = next(i), k = previous(i);
        const dvec3 normal = n[i] + n[j], to_third = p[k] - 0.5 * (p[i] + p[j]);
        dvec3 middle(0.5);
        middle[k] = 0;
        const glm::dvec2 db = raised(middle).db; // of the second and third weight, the first one what is left
        const dvec3 by_weight(0, db.x, db.y);
        const double has = by_weight[k] - 0.5 * (by_weight[i] + by_weight[j]), length = glm::length(normal);
        if (length > Surface::least_normal) lacks[i] = -dot(to_third, normal) / length - has;
    }
    for (uint32_t i = 0; i < 3; ++i) across[i] = 16 * lacks[i];
    const dvec3 facet_normal = surface.facet_normal(face, side);
    flat =
        std::all_of(n, n + 3, [&](const dvec3& normal) { return glm::distance(normal, facet_normal) < same_normal; });
    for (uint32_t i : {1u, 2u}) p[i] -= p[0], n[i] -= n[0];
    area = cross(p[1], p[2]);
    edge_m = std::sqrt(glm::length(area));
}

FacetLines::Height FacetLines::raised(const dvec3& b) const noexcept
{
    Height s;
    double db[3] = {};
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t j = next(i);
        const double mean = b[i] * rise[i] + b[j] * back[i];
        s.m += b[i] * b[j] * mean;
        db[i] += b[j] * (mean + b[i] * rise[i]);
        db[j] += b[i] * (mean + b[j] * back[i]);
    }
    const double all = b[0] * b[1] * b[2];
    double inside = bubble;
    for (uint32_t i = 0; i < 3; ++i) inside += across[i] * b[i] * b[next(i)];
    s.m += inside * all;
    for (uint32_t i = 0; i < 3; ++i)
        db[i] += inside * b[next(i)] * b[previous(i)] +
                 all * (across[i] * b[next(i)] + across[previous(i)] * b[previous(i)]);
    s.db = {db[1] - db[0], db[2] - db[0]};
    return s;
}

void find_roundness(Surface& surface, unsigned threads)
{
    surface.roundness.assign(surface.fans.size() + surface.fan_parts.size(), {});
    std::vector<std::array<OfFacet, 2>> of_facets(surface.faces.size());
    in_pieces(surface.faces.size(), threads, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (auto f = static_cast<uint32_t>(begin); f < end; ++f)
            for (uint32_t side = 0; side < 2; ++side) of_facets[f][side] = roundness_of(surface, f, side);
    });
    for (uint32_t f = 0; f < surface.faces.size(); ++f)
        for (uint32_t side = 0; side < 2; ++side)
            for (uint32_t corner = 0; corner < 3; ++corner) {
                Roundness& most = surface.roundness[surface.number_of(surface.faces[f].fan_or_part[corner][side])];
                const auto& [round, upright] = of_facets[f][side];
                most.raised_m = std::max(most.raised_m, round.raised_m);
                most.bent_in_per_m = upright[corner] ? std::max(most.bent_in_per_m, round.bent_in_per_m)
                                                     : std::numeric_limits<float>::infinity();
                most.bent_out_per_m = std::max(most.bent_out_per_m, round.bent_out_per_m);
            }
}

} // namespace haptel::runtime
