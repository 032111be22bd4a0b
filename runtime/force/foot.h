// Where on an object the hand's place belongs, how deep it is there, and how both change with it.
//
// Contact holds the probe off flat facets. Felt is the smooth surface for which they stand
// (runtime/surface/facet_lines.h), sunk so far that it is nowhere above them, as textures are. Through each point P(b)
// of a facet goes a line along the normal N(b) between those of the corners, and the hand A lies on the line of its
// foot:
//
//   A = P(b) - t N(b)
//
// Facets that share an edge share the lines through it, so that the foot moves over edges without a jump. The depth is
//
//   D(A) = t |N| + s(b) - sunk(b),
//
// where the last fades as the hand gets deeper: one continuous function of the hand's place, and `push` minus its exact
// gradient: K D push is the force of the potential K D^2 / 2, whatever the mesh. Force shading, equation (1) of the
// paper, turns the force of the flat foot instead.
//
// Where the lines come close to each other, slant much, or end, `share` falls to 0, smoothly with the hand's place, and
// the flat foot has the rest.
#pragma once

#include "runtime/contact/contact.h"
#include "runtime/surface/facet_lines.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace haptel::runtime {

// Of unit normals, and of an edge: what differs by no more, as found from two sides, is one.
inline constexpr double one_place = 1e-6;

// In the space of the object. Made by the functions below, which fill it: it is made in each tick.
struct Foot {
    uint32_t face, side;
    glm::dvec3 barycentric; // each >= 0 but for rounding, sum 1
    glm::dvec3 at_m;        // on that facet: where the texture is felt
    double depth_m;         // of the hand below what is felt there without a texture; less than 0: above it
    glm::dvec3 way;         // unit: along which that depth is measured
    glm::dvec3 normal;      // unit: of what is felt there
    double normal_length;   // of a smooth foot: of that between the corners' normals
    glm::dvec3 push;        // of a spring of depth_m: of a smooth foot minus its gradient, else `normal`
    // How at_m moves with the hand: by the weights of the second and the third corner along edges of the facet, and by
    // them the hand along `line_m`; `turned_per_m2` is `normal` over the volume of all three. Of a flat foot that is 0:
    // it moves as the hand does, across `normal`; on an edge along `line` alone, else so many times as far, `across`.
    glm::dvec3 edge_m[2], line_m[2], turned_per_m2;
    glm::dvec3 line; // unit, or 0
    double across;
    double share;        // 0 .. 1, of this foot in what is felt
    glm::dvec3 share_dp; // 1/m: its gradient

    bool is_flat() const { return turned_per_m2 == glm::dvec3(0); }
    // What the hand feels of a gradient by at_m.
    glm::dvec3 felt(const glm::dvec3& gradient) const
    {
        if (is_flat()) {
            const glm::dvec3 along = gradient - glm::dot(gradient, normal) * normal;
            return across == 1 ? along : across * along + (1 - across) * glm::dot(gradient, line) * line;
        }
        return by_weights(glm::dot(gradient, edge_m[0]), glm::dot(gradient, edge_m[1]));
    }
    // And of what changes so much with both weights.
    glm::dvec3 by_weights(double second, double third) const
    {
        return glm::cross(turned_per_m2, third * line_m[0] - second * line_m[1]);
    }
};

// As contact found it: the facets', along the normal of the contact.
Foot flat_foot(const Surface& surface, const Contact& contact) noexcept;

// The same with equation (1) of the paper: the normal between the corners' is the direction of the force.
Foot paper_foot(const Surface& surface, const Contact& contact) noexcept;

// Straight below a contact, so deep as that says.
inline glm::dvec3 hand_below(const Contact& contact)
{
    return contact.proxy_m + (contact.radius_m - contact.depth_m) * contact.normal;
}

// On the smooth surface, of a hand near `contact`. `last`: the facet of the tick before on the same surface, which is
// mostly that of this one. Nothing of it is felt (share 0) where there is none.
Foot smooth_foot(const Surface& surface, const Contact& contact, const glm::dvec3& hand_m, FacetLines& last) noexcept;

// 1/m: how the normal of a smooth foot on that facet turns with the hand's place.
glm::dmat3 turning(const FacetLines& lines, const Foot& foot) noexcept;

} // namespace haptel::runtime
