// The walk of proxy.h from the inside: its steps, which walk.cpp takes on faces, edges and vertices and walk_walls.cpp
// where faces pierce each other. Internal to the runtime.
#pragma once

#include "runtime/contact/intersecting_faces.h"
#include "runtime/contact/proxy.h"
#include "runtime/surface/corner.h"

namespace haptel::runtime {

// The only tolerances, in lattice units (below 2e-12 of the object): they cover the rounding of the proxy, which is
// a double and no lattice point, and nothing else.
namespace tolerance {
constexpr double lift_off = 8;    // height of the hand at which the surface lets go
constexpr double feature = 32;    // nearer to an edge or a vertex than this is on it
constexpr double departure = 64;  // least way that is worth a turn: more than `feature`, else cycles
constexpr double on_plane = 4;    // nearer to a neighbour's plane than this is on it
constexpr double clear_above = 2; // height that rounding to the lattice cannot undo
} // namespace tolerance

class Walk {
public:
    Walk(const Surface& surface, Proxy& proxy, const glm::dvec3& hand, const WalkFriction& friction, WalkCount& count)
        : surface_(surface), proxy_(proxy), hand_(hand), friction_(friction), count_(count)
    {
    }

    void run(uint32_t step_limit, WalkPath* path);

private:
    enum class Step : uint8_t { again, stop };

    const glm::dvec3& vertex(uint32_t face, uint32_t corner) const
    {
        return surface_.vertices[surface_.faces[face].vertex[corner]];
    }
    glm::dvec3 edge_vector(uint32_t face, uint32_t edge) const { return vertex(face, next(edge)) - vertex(face, edge); }
    // Within the face, at a right angle to its edge, as long as the edge.
    glm::dvec3 inward(uint32_t face, uint32_t edge) const
    {
        return glm::cross(surface_.faces[face].normal, edge_vector(face, edge));
    }

    void settle();
    bool step_onto_edge(uint32_t face, uint32_t side, uint32_t edge);
    bool step(uint32_t face, uint32_t side, uint32_t edge, const glm::dvec3& place);

    Step from_face();
    bool touches_across(const SideEdge& link, uint32_t face, uint32_t edge) const;
    Step from_edge();
    Step leave_edge(uint32_t face, uint32_t edge, const SideEdge& link);
    bool free_of_edge(uint32_t face, uint32_t edge, uint32_t side) const;
    Step from_vertex();

    Step leave(const StartsOn& start, const glm::dvec3& offset);
    double share_past_friction(double way, double depth);
    double pressed_at_edge(uint32_t face, uint32_t edge, uint32_t side) const;
    Step slide(uint32_t face, uint32_t side, uint32_t from_edge, uint32_t or_edge);
    Step go_within(uint32_t face, uint32_t side, const glm::dvec3& target, uint32_t from_edge, uint32_t or_edge);
    Step slide_along(uint32_t face, uint32_t edge, uint32_t side);

    // Among walls, see walk_walls.cpp.
    Step from_face_among_walls();
    bool walls_at_edge(uint32_t face, uint32_t edge, uint32_t side, PlaneSet& planes) const;
    Step from_edge_among_walls(const PlaneSet& planes, uint32_t edge);
    Step descend(const PlaneSet& planes, uint32_t owned, const ConeProjection& projection, uint32_t from_edge);
    void hold(const PlaneSet& planes, uint32_t owned, const ConeProjection& projection);
    Step slide_along_crease(const Plane& face, const Plane& wall, uint32_t from_edge);
    Step change_over(const PlaneSet& planes, uint32_t owned, const ConeProjection& projection);
    Step went(const glm::dvec3& from);
    Step turn();

    const Surface& surface_;
    Proxy& proxy_;
    const glm::dvec3& hand_;
    const WalkFriction& friction_;
    WalkCount& count_;
    bool moved_ = false;
};

} // namespace haptel::runtime
