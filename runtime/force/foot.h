// Where on an object the hand's place belongs, how deep it is there, and how both change with it.
//
// Contact holds the probe off flat facets. Felt is the smooth surface for which they stand. Through each point P(b) of
// a facet goes a straight line along the normal N(b) between the shading normals of its corners; the hand A lies on the
// line of its foot:
//
//   A = P(b) - t N(b)
//
// Facets that share an edge share the lines through it, so that the foot moves over edges without a jump, at any depth
// above the centres of curvature. The smooth surface is the facet raised by s(b), the cubic that is 0 at the corners
// and rises from each as the normal there says (as PN triangles do: Vlachos and others 2001). The depth is
//
//   D(A) = t |N| + s(b),
//
// but shallower than some times s, where it becomes 0 on the facets that contact knows. It is one continuous function
// of the hand's place, and `push` minus its exact gradient: K D push is the force of the potential K D^2 / 2, whatever
// the mesh. Force shading, equation (1) of the paper, turns the force of the flat foot instead.
//
// Near the centres of curvature and beyond borders and creases the lines meet or end. There `share` falls to 0,
// smoothly with the hand's place, and the flat foot has the rest.
#pragma once

#include "runtime/contact/contact.h"
#include "runtime/surface/surface.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace haptel::runtime {

// In the space of the object.
struct Foot {
    uint32_t face = 0, side = 0;
    glm::dvec3 barycentric{1, 0, 0}; // each >= 0 but for rounding, sum 1
    glm::dvec3 at_m{0};              // on that facet: where the texture is felt
    double depth_m = 0;              // of the hand below what is felt there without a texture; less than 0: above it
    glm::dvec3 way{0, 0, 1};         // unit: along which that depth is measured
    glm::dvec3 normal{0, 0, 1};      // unit: of what is felt there, across which friction holds
    glm::dvec3 push{0, 0, 1};        // of a spring of depth_m: of a smooth foot minus its gradient, else `normal`
    glm::dvec3 lag_m{0};             // Contact::lag_m, across `normal` on a smooth foot
    glm::dmat3 at_dp{0};             // how at_m moves with the hand: column j by its j-th coordinate
    double share = 1;                // 0 .. 1, of this foot in what is felt
    glm::dvec3 share_dp{0};          // 1/m: its gradient
};

// As contact found it: the facets', along the normal of the contact.
Foot flat_foot(const Contact& contact) noexcept;

// The same with equation (1) of the paper: the normal between the corners' is the direction of the force.
Foot paper_foot(const Surface& surface, const Contact& contact) noexcept;

// On the smooth surface. `held_above_m`: where the hand holds the probe, above the point that touches: the radius of a
// ball. Nothing of it is felt (share 0) where there is none.
Foot smooth_foot(const Surface& surface, const Contact& contact, double held_above_m) noexcept;

} // namespace haptel::runtime
