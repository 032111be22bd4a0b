#include "runtime/surface/build/build.h"
#include "runtime/surface/facet_lines.h"
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

using BothSides = std::array<OfFacet, 2>;

// Of the side that the lines are of, and of the other one if its normals are the opposite ones.
BothSides roundness_of(const FacetLines& lines, const dvec3& facet_normal)
{
    BothSides found{};
    if (lines.flat) {
        for (OfFacet& side : found) std::fill_n(side.upright, 3, true);
        return found;
    }
    double most = 0, least = 0;
    for (int i = 0; i <= grid; ++i)
        for (int j = 0; j + i <= grid; ++j) {
            const double s = lines.raised(dvec3(grid - i - j, i, j) / double(grid)).m;
            most = std::max(most, s), least = std::min(least, s);
        }
    found[0].round.raised_m = as_float_above(between_places * most);
    found[1].round.raised_m = as_float_above(between_places * -least);

    // The normal's derivative in the plane of the facet, its symmetric part.
    const dvec3 x = glm::normalize(lines.p[1]), y = glm::normalize(cross(lines.area, x));
    const double length = dot(lines.p[1], x), place = dot(lines.p[2], x), height = dot(lines.p[2], y);
    const dvec3 by_x = lines.n[1] / length, by_y = (lines.n[2] - place * by_x) / height;
    const double xx = dot(by_x, x), yy = dot(by_y, y), xy = 0.5 * (dot(by_x, y) + dot(by_y, x));
    const double mean = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy);
    found[0].round.bent_in_per_m = found[1].round.bent_out_per_m = as_float_above(std::max(0.0, mean + apart));
    found[0].round.bent_out_per_m = found[1].round.bent_in_per_m = as_float_above(std::max(0.0, apart - mean));
    for (int i = 0; i < 3; ++i)
        found[0].upright[i] = found[1].upright[i] =
            dot(facet_normal, i ? lines.n[0] + lines.n[i] : lines.n[0]) > least_upright;
    return found;
}

BothSides roundness_of(const Surface& surface, uint32_t face)
{
    const auto& corners = surface.faces[face].fan_or_part;
    const bool opposite = std::all_of(corners.begin(), corners.end(), [&](const auto& sides) {
        return surface.shading_normal(sides[0]) == -surface.shading_normal(sides[1]);
    });
    BothSides found = roundness_of(FacetLines(surface, face, 0), surface.facet_normal(face, 0));
    if (!opposite) found[1] = roundness_of(FacetLines(surface, face, 1), surface.facet_normal(face, 1))[0];
    return found;
}

} // namespace

void find_roundness(Surface& surface, unsigned threads)
{
    surface.roundness.assign(surface.fans.size() + surface.fan_parts.size(), {});
    std::vector<BothSides> of_facets(surface.faces.size());
    each_in_parallel(surface.faces.size(), threads, [&](uint32_t f) { of_facets[f] = roundness_of(surface, f); });
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
