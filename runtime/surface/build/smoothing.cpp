#include "runtime/surface/build/build.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace haptel::runtime {

namespace {

constexpr uint32_t no_normal = ~0u;

// The sectors of a fan in the order in which they lie around the vertex.
struct Ring {
    std::vector<Sector> sectors;
    bool closed = false;

    Ring(const Surface& surface, const Sector& start)
    {
        Sector sector = start;
        uint32_t edge = start.corner;
        do sectors.push_back(sector);
        while (turn(surface, sector, edge) && !(closed = sector == start));
        if (closed) return;
        const auto ahead = static_cast<std::ptrdiff_t>(sectors.size());
        sector = start;
        edge = previous(start.corner);
        while (turn(surface, sector, edge)) sectors.push_back(sector);
        std::rotate(sectors.begin(), sectors.begin() + ahead, sectors.end());
        std::reverse(sectors.begin(), sectors.end() - ahead);
    }
};

glm::dvec3 normal_of(const Surface& surface, const Sector& sector)
{
    return surface.facet_normal(sector.face, sector.side);
}

class Smoothing {
public:
    Smoothing(Surface& surface, double crease_deg) : surface_(surface), crease_rad_(glm::radians(crease_deg)) {}

    void make(const Sector& start)
    {
        Ring ring(surface_, start);
        std::vector<Sector>& sectors = ring.sectors;
        const size_t count = sectors.size();
        const auto ends = [&](size_t i) { return is_crease(sectors[i], sectors[(i + 1) % count]); };
        if (ring.closed) // a group must not run over the end of the list
            for (size_t i = 0; i < count; ++i)
                if (ends(i)) {
                    std::rotate(sectors.begin(), sectors.begin() + static_cast<std::ptrdiff_t>(i + 1), sectors.end());
                    break;
                }
        for (size_t begin = 0, i = 0; i < count; ++i)
            if (i + 1 == count || ends(i)) {
                const bool whole = ring.closed && i + 1 - begin == count; // a border is a crease
                add_group(std::span(sectors).subspan(begin, i + 1 - begin), whole);
                begin = i + 1;
            }
    }

private:
    bool is_crease(const Sector& a, const Sector& b) const
    {
        if (const std::vector<uint32_t>& groups = surface_.smoothing_groups; !groups.empty())
            if (groups[a.face] == 0 || groups[a.face] != groups[b.face]) return true;
        const glm::dvec3 m = normal_of(surface_, a), n = normal_of(surface_, b);
        return std::atan2(glm::length(glm::cross(m, n)), glm::dot(m, n)) > crease_rad_;
    }

    void add_group(std::span<const Sector> sectors, bool whole)
    {
        const uint32_t index = uint32_t(surface_.shading_normals.size());
        glm::dvec3 sum{0};
        for (const Sector& sector : sectors) {
            sum += weighted_normal(surface_, sector);
            surface_.shading_normal_of[sector.face][sector.corner][sector.side] = index;
        }
        if (sectors.size() == 1) sum = normal_of(surface_, sectors.front()); // to the last bit
        const double length = sectors.size() == 1 ? 1 : glm::length(sum);
        surface_.shading_normals.push_back({length > 1e-9 ? sum / length : glm::dvec3(0), whole});
    }

    Surface& surface_;
    double crease_rad_;
};

// Largest spectral norm of the derivative of the normal on one face, which is J / |s| without its part along s: s the
// interpolated sum of vertex normals, J its constant derivative.
double turn_max(const Surface& surface, uint32_t face, uint32_t side)
{
    glm::dvec3 n[3];
    for (size_t i = 0; i < 3; ++i) n[i] = surface.shading_normals[surface.shading_normal_of[face][i][side]].normal;

    // For unit normals and weights of sum 1: |s|^2 = 1 - sum of w_i w_j |n_i - n_j|^2 over the three pairs.
    double apart = 0;
    bool unit = true;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 between = n[i] - n[(i + 1) % 3];
        apart = std::max(apart, glm::dot(between, between));
        unit = unit && n[i] != glm::dvec3(0);
    }
    const double shortest_squared = unit ? 1 - apart / 3 : 0; // the sum of w_i w_j over pairs is at most 1/3

    // J in the plane of the face, its columns along the first edge and across it.
    const auto& corner = surface.faces[face].vertex;
    const glm::dvec3 along = surface.vertices[corner[1]] - surface.vertices[corner[0]];
    const glm::dvec3 other = surface.vertices[corner[2]] - surface.vertices[corner[0]];
    const double length = glm::length(along), place = glm::dot(other, along) / length;
    const double height = glm::length(glm::cross(along, other)) / length;
    const glm::dvec3 by_along = (n[1] - n[0]) / length;
    const glm::dvec3 by_across = ((n[2] - n[0]) - place * by_along) / height;
    const double a = glm::dot(by_along, by_along), b = glm::dot(by_across, by_across),
                 c = glm::dot(by_along, by_across);
    const double norm = std::sqrt(0.5 * (a + b + std::hypot(a - b, 2 * c)));
    const double shortest = std::max(std::sqrt(std::max(0.0, shortest_squared)), Surface::least_normal);
    return norm / (shortest * surface.lattice.unit_m);
}

} // namespace

void make_shading_normals(Surface& surface, double crease_deg)
{
    surface.shading_normal_of.assign(surface.faces.size(),
                                     {{{no_normal, no_normal}, {no_normal, no_normal}, {no_normal, no_normal}}});
    Smoothing smoothing(surface, crease_deg);
    for (uint32_t f = 0; f < surface.faces.size(); ++f)
        for (uint32_t corner = 0; corner < 3; ++corner)
            for (uint32_t side = 0; side < 2; ++side)
                if (surface.shading_normal_of[f][corner][side] == no_normal) smoothing.make({f, corner, side});

    surface.normal_turn_max_per_m = 0;
    for (uint32_t f = 0; f < surface.faces.size(); ++f)
        for (uint32_t side = 0; side < 2; ++side)
            surface.normal_turn_max_per_m = std::max(surface.normal_turn_max_per_m, turn_max(surface, f, side));
    // Of rounding, here and where the derivative is made.
    surface.normal_turn_max_per_m *= 1 + 1e-9;
}

} // namespace haptel::runtime
