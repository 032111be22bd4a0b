#include "runtime/contact/walk.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

using namespace tolerance;

// After a move that a wall has ended: on, now with that wall around, unless there was none.
Walk::Step Walk::went(const glm::dvec3& from)
{
    const double way = glm::distance(from, proxy_.at);
    if (way < 1) return Step::stop;
    return way > departure ? Step::again : turn();
}

// A step that leads no nearer by itself.
Walk::Step Walk::turn()
{
    return ++count_.wall_turns > WalkCount::most_wall_turns ? Step::stop : Step::again;
}

Walk::Step Walk::from_face_among_walls()
{
    proxy_.at = off_walls(surface_, proxy_.face, proxy_.at);
    PlaneSet planes;
    planes.add({proxy_.face, proxy_.side, surface_.facet_normal(proxy_.face, proxy_.side), false});
    add_walls(surface_, proxy_.face, proxy_.at, planes);
    if (planes.count == 1) return slide(proxy_.face, proxy_.side, 3, 3);
    return descend(planes, 1, project_on_cone(planes, hand_ - proxy_.at), 3);
}

// The two faces of the edge and the walls of both that the proxy is beside. False: there is none.
bool Walk::walls_at_edge(uint32_t face, uint32_t edge, uint32_t side, PlaneSet& planes) const
{
    const SideEdge link = surface_.faces[face].link[edge][side];
    if (!has_walls(surface_, face) && !has_walls(surface_, link.face())) return false;
    planes.add({face, side, surface_.facet_normal(face, side), false});
    planes.add({link.face(), link.side(), surface_.facet_normal(link.face(), link.side()), false});
    add_walls(surface_, face, proxy_.at, planes);
    if (link.face() != face) add_walls(surface_, link.face(), proxy_.at, planes);
    return planes.count > 2;
}

// At an edge there are two sets of planes, for the one face and for the other, each bounded by the plane that rises
// over the edge; in a valley the other face bounds both; beyond a border there is none. The steeper way counts.
Walk::Step Walk::from_edge_among_walls(const PlaneSet& planes, uint32_t edge)
{
    const SideEdge faces[2] = {SideEdge(proxy_.face, edge, proxy_.side),
                               surface_.faces[proxy_.face].link[edge][proxy_.side]};
    const glm::dvec3& tip = vertex(faces[1].face(), previous(faces[1].edge()));
    const bool border = faces[1].face() == proxy_.face;
    const bool valley = !border && glm::dot(tip - vertex(proxy_.face, edge), planes.plane[0].normal) > on_plane;
    PlaneSet sets[2];
    ConeProjection projections[2];
    uint32_t owned[2];
    for (uint32_t i = 0; i < 2; ++i) {
        const glm::dvec3 in = glm::normalize(inward(faces[i].face(), faces[i].edge()));
        const bool beyond = border && i == 1;
        if (!beyond) sets[i].add(planes.plane[i]);
        sets[i].add({faces[i].face(), faces[i].side(), beyond ? -in : in, true});
        if (valley) sets[i].add(planes.plane[1 - i]);
        owned[i] = sets[i].count;
        for (uint32_t k = 2; k < planes.count; ++k) sets[i].add(planes.plane[k], PlaneSet::most + planes.body[k]);
        projections[i] = project_on_cone(sets[i], hand_ - proxy_.at);
    }
    if (border && projections[1].runs_on(0))
        projections[1].way = glm::dvec3(0); // under the border: the proxy holds on to it
    // In a narrow valley the first set holds ways along the second face.
    const bool second = glm::length(projections[1].way) > glm::length(projections[0].way) ||
                        (valley && projections[0].runs_on(2) && !projections[0].runs_on(0));
    return descend(sets[second], owned[second], projections[second], faces[second].edge());
}

// On along the steepest way, from the first of the planes. `owned`: how many of them are no walls;
// `from_edge`: of the first, or 3 if the proxy is on a face.
Walk::Step Walk::descend(const PlaneSet& planes, uint32_t owned, const ConeProjection& projection, uint32_t from_edge)
{
    hold(planes, owned, projection);
    if (glm::length(projection.way) <= departure) return Step::stop;
    const Plane& own = planes.plane[0];
    uint32_t wall = 0;
    for (uint32_t k = 0; k < projection.count; ++k)
        if (projection.plane[k] >= owned) wall = projection.plane[k];
    if (wall == 0 && own.is_ridge) return Step::stop;
    if (wall == 0) {
        const bool on_edge = owned > 1 && (projection.runs_on(1) || (owned > 2 && projection.runs_on(2)));
        return on_edge ? slide_along(own.face, from_edge, own.side) : slide(own.face, own.side, from_edge, 3);
    }
    if (!projection.runs_on(0)) return change_over(planes, owned, projection);
    // The wall may end before the way does: from there it may go on otherwise.
    const glm::dvec3 from = proxy_.at;
    const Step step = slide_along_crease(own, planes.plane[wall], from_edge);
    return step == Step::stop ? went(from) : step;
}

// Notes what holds the proxy where it is, should it rest here.
void Walk::hold(const PlaneSet& planes, uint32_t owned, const ConeProjection& projection)
{
    const bool pair = projection.count == 2,
               by_wall = pair && std::max(projection.plane[0], projection.plane[1]) >= owned;
    proxy_.at_wall = by_wall || projection.count == 3;
    proxy_.crease = glm::dvec3(0);
    if (by_wall)
        proxy_.crease = glm::normalize(
            glm::cross(planes.plane[projection.plane[0]].normal, planes.plane[projection.plane[1]].normal));
}

// Along the crease of a face and its wall, within the face.
Walk::Step Walk::slide_along_crease(const Plane& face, const Plane& wall, uint32_t from_edge)
{
    const glm::dvec3 crease = glm::normalize(glm::cross(face.normal, wall.normal));
    const glm::dvec3 to_hand = hand_ - proxy_.at, way = glm::dot(to_hand, crease) * crease;
    const double share = share_past_friction(glm::length(way), glm::length(to_hand - way));
    if (share == 0) return Step::stop;
    proxy_.on = Proxy::On::face;
    proxy_.face = face.face;
    proxy_.side = face.side;
    return go_within(face.face, face.side, proxy_.at + share * way, from_edge, 3);
}

// From the plane that the proxy is on to a wall that the way runs on: the few units between them are swept like any
// free way. Of triangles in one plane it is the one that the place is on.
Walk::Step Walk::change_over(const PlaneSet& planes, uint32_t owned, const ConeProjection& projection)
{
    const double rounding = 1e-9 * glm::length(projection.way);
    for (uint32_t k = owned; k < planes.count; ++k) {
        const Plane& wall = planes.plane[k];
        if (std::abs(glm::dot(wall.normal, projection.way)) > rounding) continue;
        const uint32_t other = projection.plane[projection.plane[0] == k ? 1 : 0];
        glm::dvec3 place;
        if (!onto_wall(surface_, planes, k, projection.count > 1 ? other : k, proxy_.at, place)) continue;
        const glm::dvec3 from = glm::round(proxy_.at + clear_above * planes.plane[0].normal),
                         to = glm::round(place + clear_above * wall.normal);
        Crossing crossing;
        if (first_crossing(surface_, from, to, StartsOn::nothing(), crossing, count_.collision)) continue;
        proxy_.on = Proxy::On::face;
        proxy_.face = wall.face;
        proxy_.side = wall.side;
        proxy_.at = place;
        return turn();
    }
    return Step::stop;
}

} // namespace haptel::runtime
