// Where faces pierce each other without sharing edges, the links do not see it: the faces listed in Surface::pierced_by
// are walls that stand on the face walked on. The proxy keeps a little off their planes, so that no rounding can put it
// behind one, and every move within a face is tested against its walls. Beside walls the planes around the proxy bound
// half-spaces, and up to three of them at once decide where it goes. Lattice units.
#pragma once

#include "runtime/surface/collision.h"
#include "runtime/surface/surface.h"

namespace haptel::runtime {

inline bool has_walls(const Surface& surface, uint32_t face)
{
    return surface.faces[face].pierced_begin != surface.faces[face].pierced_end;
}

// A face seen from one side; or the plane that rises over a ridge, as the bound of one of the ridge's two faces.
struct Plane {
    uint32_t face = 0, side = 0;
    glm::dvec3 normal{0}; // unit, toward that side; of a ridge's plane into the face
    bool is_ridge = false;
};

// The planes around a place. Each bounds a half-space, and the proxy moves in the intersection of them: the first one,
// or the first two, carry the proxy, the others are walls within reach. At most `most`; further ones are left out.
struct PlaneSet {
    static constexpr uint32_t most = 8;
    Plane plane[most];
    // Walls that meet in ridges are one body, by the same number: to be before one of them is to be out of it.
    uint32_t body[most];
    uint32_t count = 0;

    void add(const Plane& another) { add(another, count); }
    void add(const Plane& another, uint32_t of_body)
    {
        if (count == most) return;
        body[count] = of_body;
        plane[count++] = another;
    }
    void join(uint32_t one, uint32_t other)
    {
        const uint32_t from = body[other], to = body[one];
        for (uint32_t k = 0; k < count; ++k)
            if (body[k] == from) body[k] = to;
    }
};

// Adds the walls of the face that the place is beside.
void add_walls(const Surface& surface, uint32_t face, const glm::dvec3& at, PlaneSet& planes) noexcept;

// The part of a vector `way` that is left when it is projected on the cone of directions that all half-spaces allow:
// the way along which the distance to way's end falls fastest. `plane`: indices of the up to three planes that it runs
// on.
struct ConeProjection {
    glm::dvec3 way{0};
    uint32_t plane[3] = {};
    uint32_t count = 0;

    bool runs_on(uint32_t index) const
    {
        return (count > 0 && plane[0] == index) || (count > 1 && plane[1] == index) || (count > 2 && plane[2] == index);
    }
};
ConeProjection project_on_cone(const PlaneSet& planes, const glm::dvec3& way) noexcept;

// How much of the straight way within the face may be gone: all, or up to where it comes too near to a wall.
double share_before_walls(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to) noexcept;
inline double open_share(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to)
{
    return has_walls(surface, face) ? share_before_walls(surface, face, from, to) : 1.0;
}

// Whether a step of few units, onto an edge or a vertex of the face, stays on this side of all its walls.
bool stays_before_walls(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to) noexcept;
inline bool may_step(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to)
{
    return !has_walls(surface, face) || stays_before_walls(surface, face, from, to);
}

// The place, moved within the face off the walls that it is too near to; the place itself if that cannot be done.
glm::dvec3 off_walls(const Surface& surface, uint32_t face, const glm::dvec3& at) noexcept;

// A place near `at` that is on a wall, one of the planes, and off the others, or just beside one of them (`along`; the
// wall itself: none). False: they are too nearly parallel, or that is not on the wall's triangle.
bool onto_wall(const Surface& surface, const PlaneSet& planes, uint32_t wall, uint32_t along, const glm::dvec3& at,
               glm::dvec3& place) noexcept;

// The point where the way from `from` to `to` lands on a face, moved within the face off the walls beside it, to the
// side on which the way arrives. Both ends must be lattice points.
glm::dvec3 landing_off_walls(const Surface& surface, const Crossing& landing, const glm::dvec3& from,
                             const glm::dvec3& to, const glm::dvec3& point) noexcept;

} // namespace haptel::runtime
