// Faces around a vertex, walked by links: the fan that a proxy at the vertex sees from its side.
#pragma once

#include "runtime/surface/surface.h"

#include <limits>
#include <optional>

namespace haptel::runtime {

// One face of a fan, by its corner at the vertex and the side that is seen.
struct Sector {
    uint32_t face = 0, corner = 0, side = 0;
    bool operator==(const Sector&) const = default;
};

// Corner and edge indices of a triangle: edge i runs from corner i to corner next(i).
inline uint32_t next(uint32_t i)
{
    return i == 2 ? 0 : i + 1;
}
inline uint32_t previous(uint32_t i)
{
    return i == 0 ? 2 : i - 1;
}

// Both edges of a sector, from the vertex: that which starts there, and that which ends there.
struct Spokes {
    glm::dvec3 leaving, arriving;

    Spokes(const Surface& surface, const Sector& of)
        : leaving(surface.vertex(of.face, next(of.corner)) - surface.vertex(of.face, of.corner))
        , arriving(surface.vertex(of.face, previous(of.corner)) - surface.vertex(of.face, of.corner))
    {
    }
};

// What of its face a point lies on, by its barycentric coordinates, which are 0 there but for rounding.
struct Feature {
    enum class On : uint8_t { face, edge, vertex };
    On on = On::face;
    uint32_t index = 0; // of the edge or the corner
};
Feature feature_at(const glm::dvec3& barycentric) noexcept;

// Over `edge`, one of the two at the sector's corner, into the neighbour; `edge` becomes the neighbour's other edge at
// the vertex. False at a border of the surface.
inline bool turn(const Surface& surface, Sector& sector, uint32_t& edge)
{
    const Face& face = surface.faces[sector.face];
    const SideEdge link = face.link[edge][sector.side];
    if (link.face() == sector.face) return false;
    const bool starts_here = surface.faces[link.face()].vertex[link.edge()] == face.vertex[sector.corner];
    const uint32_t corner = starts_here ? link.edge() : next(link.edge());
    sector = {link.face(), corner, link.side()};
    edge = starts_here ? previous(corner) : corner;
    return true;
}

// Calls visit(sector) once for each sector of the fan, `start` first. Returns whether the fan is closed; an open one
// ends at borders.
template <class Visit>
bool for_each_sector(const Surface& surface, const Sector& start, Visit&& visit)
{
    Sector sector = start;
    uint32_t edge = start.corner;
    visit(sector);
    while (turn(surface, sector, edge)) {
        if (sector == start) return true;
        visit(sector);
    }
    sector = start;
    edge = previous(start.corner);
    while (turn(surface, sector, edge)) visit(sector);
    return false;
}

// Of a sector its neighbour over `edge`, one of the two at its corner, if the shading normal there is the same; else,
// and at a border, nothing.
inline std::optional<Sector> smooth_neighbour(const Surface& surface, Sector sector, uint32_t edge)
{
    const uint32_t own = surface.faces[sector.face].fan_or_part[sector.corner][sector.side];
    const bool goes_on = turn(surface, sector, edge);
    if (!goes_on || surface.faces[sector.face].fan_or_part[sector.corner][sector.side] != own) return std::nullopt;
    return sector;
}

// Whether the point lies on an edge or a vertex at which the shading normals of the faces around differ, or on a
// border, off which a ball is held by its rim.
bool on_crease(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept;

// Sum of the facets' normals of a fan times their angles at the vertex: who is outside of all that lies around a closed
// one is in front of it (J. A. Baerentzen and H. Aanaes, 2005). Not of unit length.
struct FanOutward {
    glm::dvec3 normal{0};
    bool closed = false;

    FanOutward(const Surface& surface, const Sector& start) noexcept;
};

// The point of a fan, its sectors taken as endless, that is nearest to where a vector from the vertex leads.
struct NearestInFan {
    static constexpr uint32_t into_sector = 3;

    double way = 0; // from the vertex to that point; 0: it is the vertex itself
    // From that point to where the vector leads. Of points far from the vertex this tells which is nearer; their ways
    // are equal within rounding, and in a valley a hand that is behind one face may be before the other.
    double across_square = std::numeric_limits<double>::infinity();
    Sector sector;
    uint32_t edge = into_sector; // or the edge of the sector that the point is on

    // Takes in one more fan; equal ways go to the first. Returns whether the fan is closed.
    bool consider(const Surface& surface, const Sector& start, const glm::dvec3& to) noexcept;
};

} // namespace haptel::runtime
