// A straight shaft and the edges of a surface: where they are nearest, and when a moving shaft meets one. Lattice
// units.
#pragma once

#include "runtime/contact/project.h"
#include "runtime/geometry/lattice.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cstdint>

namespace haptel::runtime {

// How far the ends are from each other's, of the pair that is farther.
inline double farther(const Shaft& a, const Shaft& b)
{
    return std::max(glm::distance(a.tip, b.tip), glm::distance(a.tail, b.tail));
}

// In lattice units. What rests does so at `rest_gap`, the radius of its ends, so that nothing changes where an edge
// goes by an end. An edge that is crossed reaches beyond its ends by `reach`, so that nothing slips through at a
// vertex. One that is rested on holds on beyond its end by `let_go`: in a corner it takes turns with the next
// otherwise.
namespace shaft_tolerance {
constexpr double rest_gap = Lattice::point_radius;
constexpr double reach = 16;
constexpr double let_go = 2 * rest_gap; // beyond this an edge holds no more, nor
constexpr double let_go_by_end = 1024;  // what is this far beyond the shaft's
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
    bool within(double off_shaft, double off_edge) const
    {
        return on_shaft * shaft_length >= -off_shaft && (on_shaft - 1) * shaft_length <= off_shaft &&
               on_edge >= -off_edge && on_edge <= edge_length + off_edge;
    }
};
Passing passing(const Shaft& shaft, const glm::dvec3& edge0, const glm::dvec3& edge1) noexcept;

// A straight move of both ends meets an edge.
struct EdgeMeeting {
    double time = 1;    // share of the move
    int side = 0;       // of the edge that the shaft came from: the sign of its height
    bool close = false; // at the end of the move the line of the shaft is within the gap of the edge's
};

// A straight move of both ends, from lattice points, so that the side on which it begins is known exactly.
class ShaftMove {
public:
    ShaftMove(const Shaft& from, const Shaft& to) noexcept;

    // The first meeting before `before`. With the ends on straight ways and the edge at rest the height changes its
    // sign where a quadratic polynomial does.
    bool meets(const glm::dvec3& edge0, const glm::dvec3& edge1, double before, EdgeMeeting& meeting) const noexcept;

private:
    Shaft from_;
    glm::dvec3 way_, along_, turn_;         // of the tip; from tip to tail, and what the move changes of it
    glm::dvec3 way_by_along_, way_by_turn_; // cross products
    double along_square_, along_then_square_;
};

} // namespace haptel::runtime
