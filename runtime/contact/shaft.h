// A straight shaft and the edges of a surface: where they are nearest, and when a moving shaft meets one. Lattice
// units.
#pragma once

#include "runtime/contact/project.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cstdint>

namespace haptel::runtime {

// How far the ends are from each other's, of the pair that is farther.
inline double farther(const Shaft& a, const Shaft& b)
{
    return std::max(glm::distance(a.tip, b.tip), glm::distance(a.tail, b.tail));
}

// In lattice units, below 1e-9 of the object's size all of them together. What rests does so at `rest_gap`, far
// above what rounding does; each edge reaches beyond its ends by `reach`, so that nothing slips through at a vertex:
// less than the gap, for what rests on one edge of a vertex must not meet the ends of others there.
namespace shaft_tolerance {
constexpr double rest_gap = 128;
constexpr double reach = 16;
constexpr double let_go = 64;          // beyond its end an edge holds no more, nor
constexpr double let_go_by_end = 1024; // what is this far beyond the shaft's
constexpr double parallel = 1e-7;      // sine of the angle below which a shaft and an edge have no normal
} // namespace shaft_tolerance

// The lines of a shaft and an edge, where they are nearest.
struct Passing {
    bool parallel = false;
    glm::dvec3 normal{0}; // unit, at right angles to both: shaft x edge
    double height = 0;    // of the shaft over the edge along it
    double on_shaft = 0;  // share of the shaft, 0 at its tip
    double on_edge = 0;   // lattice units from the edge's first end
    double edge_length = 0, shaft_length = 0;
    glm::dvec3 edge_point{0};

    // Whether shaft and edge pass each other, or are off their ends by no more than that.
    bool within(double off_tip, double off_tail, double off_edge) const
    {
        return on_shaft * shaft_length >= -off_tip && (on_shaft - 1) * shaft_length <= off_tail &&
               on_edge >= -off_edge && on_edge <= edge_length + off_edge;
    }
};
Passing passing(const Shaft& shaft, const glm::dvec3& edge0, const glm::dvec3& edge1) noexcept;

// A straight move of both ends meets an edge.
struct EdgeMeeting {
    double time = 1; // share of the move
    int side = 0;    // of the edge that the shaft came from: the sign of its height
};

// The first meeting before `before`, but for `tip_off` and `tail_off` (lattice units) at the ends of the shaft. With
// the ends on straight ways and the edge at rest the height changes its sign where a quadratic polynomial does. `from`
// has lattice points for ends, so that the side on which it begins is known exactly.
bool meets(const Shaft& from, const Shaft& to, const glm::dvec3& edge0, const glm::dvec3& edge1, double tip_off,
           double tail_off, double before, EdgeMeeting& meeting) noexcept;

} // namespace haptel::runtime
