// A facet as a piece of the smooth surface for which it stands.
//
// Through each point of the facet goes a straight line along the normal between the shading normals of its corners;
// facets that share an edge share the lines through it. The smooth surface is the facet raised along these lines by s,
// the cubic that is 0 at the corners and rises from each as the normal there says (as PN triangles do: Vlachos and
// others 2001). Whoever must not be above the facets has it sunk by a height that is linear on each facet and at each
// corner the most of s around it.
#pragma once

#include "runtime/surface/surface.h"

namespace haptel::runtime {

// Weights are those of the second and the third corner.
struct FacetLines {
    uint32_t face = ~0u, side = 0;
    glm::dvec3 p[3], n[3]; // of the corners, the normals toward the side; of the second and third: from the first one
    glm::dvec3 area;       // p[1] x p[2]
    double edge_m;         // a length of its size
    double rise[3], back[3], bubble; // s: slopes at both ends of each edge, and in the middle
    double across[3];                // and across each edge there
    glm::dvec3 sunk_m;               // by corner, as the next ones
    glm::dvec3 bent_in_per_m, bent_out_per_m;
    glm::dvec3 upright; // 1, or 0
    bool flat;          // and all lines along the facet's normal

    struct Height {
        double m = 0;
        glm::dvec2 db{0};
    };

    FacetLines() = default;
    FacetLines(const Surface& surface, uint32_t of_face, uint32_t of_side) noexcept;
    glm::dvec3 point(const glm::dvec2& b) const { return p[0] + b.x * p[1] + b.y * p[2]; }
    glm::dvec3 normal(const glm::dvec2& b) const { return n[0] + b.x * n[1] + b.y * n[2]; } // not of unit length
    Height raised(const glm::dvec3& b) const noexcept;                                      // s, by all three weights
};

// Sets the roundness of all corners.
void find_roundness(Surface& surface, unsigned threads);

} // namespace haptel::runtime
