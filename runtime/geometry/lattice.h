// The integer lattice on which contact is decided.
//
// Rounded predicates leak: two faces that share an edge may both deny a path that crosses between them. Here every
// vertex and every hand position is a lattice point, so that the sign of each orientation is exact in 128-bit integers
// (predicates.h). Lattice coordinates are doubles that hold integers. The object's half extent is 2^39 to 2^40 units,
// so one unit is below 2e-12 of it; vertices sit on every 64th point, so that a proxy rounded to the lattice is off by
// far less than the smallest feature; the hand is clamped to 2^42 units (four half extents) from the centre.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace haptel::runtime {

struct Lattice {
    static constexpr double extent = 0x1p40, vertex_spacing = 64;    // bound of vertex coordinates
    static constexpr double workspace = 4 * extent - vertex_spacing; // bound of probe coordinates
    // Of the ball that a point is where faces cut each other (end_contact.h): 0.8 to 1.5 um for an object 10 cm wide.
    // Rounding makes of its normals less than a millionth.
    static constexpr double point_radius = 0x1p24;

    glm::dvec3 centre_m{0};
    double unit_m = 1; // a power of two, so that scaling is exact

    // The lattice whose vertices can hold the box. The box must be finite; a box without extent is taken as 1 m wide.
    static Lattice around(const glm::dvec3& minimum_m, const glm::dvec3& maximum_m) noexcept;

    // Nearest point, clamped to the workspace.
    glm::dvec3 snap(const glm::dvec3& point_m) const noexcept { return snap_units(units(point_m)); }
    glm::dvec3 snap_vertex(const glm::dvec3& point_m) const noexcept; // nearest point of the coarse lattice
    // The same of a place in lattice units. Asked for in every tick, as the next one is.
    static glm::dvec3 snap_units(const glm::dvec3& units) noexcept
    {
        constexpr double round = 0x1.8p52; // adding it leaves no digit after the point; ties go to even
        return (glm::clamp(units, -workspace, workspace) + round) - round;
    }
    glm::dvec3 units(const glm::dvec3& point_m) const noexcept { return (point_m - centre_m) / unit_m; } // not rounded
    // Whether a coordinate is larger, of either sign: what rounding leaves has any sign, and is asked for every tick.
    static bool beyond_workspace(const glm::dvec3& units) noexcept
    {
        return std::fabs(units.x) > workspace || std::fabs(units.y) > workspace || std::fabs(units.z) > workspace;
    }
    // Narrows the shares between which a straight way lies in the cube that reaches so far around a place. False: none.
    static bool clip_to_cube(const glm::dvec3& from, const glm::dvec3& along, const glm::dvec3& middle, double reach,
                             double& enter, double& leave) noexcept;
    // Leaves of the straight way between two places in lattice units what lies in the workspace, its ends lattice
    // points. False: nothing does.
    static bool clip_to_workspace(glm::dvec3& from, glm::dvec3& to) noexcept;
    glm::dvec3 metres(const glm::dvec3& units) const noexcept { return centre_m + units * unit_m; }
};

} // namespace haptel::runtime
