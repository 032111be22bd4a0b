// A facet as a piece of the smooth surface for which it stands.
//
// Through each point of the facet goes a straight line along the normal between the shading normals of its corners;
// facets that share an edge share the lines through it. The smooth surface is the facet raised along these lines by s,
// which is 0 at the corners: on an edge a cubic that has the slopes that the normals at both ends say (as PN triangles
// have: Vlachos and others 2001), within what meets anything quadratic, and across the middle of each edge the slope
// that the normal there says, so that facets meet nearly without a bend. Whoever must not be above the facets has it
// sunk by a height that is linear on each facet and at each corner the most of s around it.
#pragma once

#include "runtime/surface/corner.h"

namespace haptel::runtime {

// Weights are those of the second and the third corner.
struct FacetLines {
    uint32_t face = ~0u, side = 0;
    glm::dvec3 p[3], n[3]; // of the corners, the normals toward the side; of the second and third: from the first one
    glm::dvec3 area;       // p[1] x p[2]
    // The points t of their normals below it span a facet of area - t turn + t^2 turn_dt; by n[0], and by area.
    glm::dvec3 turn, turn_dt;
    double by_normal[3], by_area[3];
    double per_m2, edge_m;           // 1 / |area|, less than 0 on the back; a length of its size
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

inline FacetLines::Height FacetLines::raised(const glm::dvec3& b) const noexcept
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

} // namespace haptel::runtime
