// Where faces pierce each other without sharing edges, the links do not see it: the faces listed in Surface::pierced_by
// are walls that stand on the face walked on. Each move within such a face is tested against its walls, and the proxy
// keeps a little off them, so that rounding cannot put it behind one. Lattice units.
#pragma once

#include "runtime/collision.h"
#include "runtime/surface.h"

namespace haptel::runtime {

inline bool has_walls(const Surface& surface, uint32_t face)
{
    return surface.faces[face].pierced_begin != surface.faces[face].pierced_end;
}

// Whether a wall of the face stands in the straight way within it; the first. Ends are rounded to the lattice.
bool blocked(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to,
             Crossing& wall) noexcept;

// How much of the way that meets the wall may be gone, keeping off its plane: a fraction, 0 if none.
double share_before(const Surface& surface, const Crossing& wall, const glm::dvec3& way) noexcept;

// Part of the way along the crease of face and wall.
glm::dvec3 along_crease(const Surface& surface, uint32_t face, const Crossing& wall, const glm::dvec3& way) noexcept;

// The point where the way from `from` to `to` lands on a face, moved within the face off the walls beside it, to the
// side on which the way arrives. Both ends must be lattice points.
glm::dvec3 off_walls(const Surface& surface, const Crossing& landing, const glm::dvec3& from, const glm::dvec3& to,
                     const glm::dvec3& point) noexcept;

} // namespace haptel::runtime
