#include "runtime/contact/intersecting_faces.h"

#include "runtime/geometry/predicates.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr double distance = 16;    // of the proxy from a wall's plane; rounding is below 1
constexpr double least = 4;        // that is left of it after a step aside
constexpr double beside_wall = 64; // nearer than this is beside it: less is not worth going
constexpr double equal = 1;        // lengths of ways that differ by less are
constexpr uint32_t none = ~0u;
constexpr double margin = 8; // so far a wall reaches beyond its outline; less than where the wall behind a ridge begins
constexpr double notice = 2; // and is known so much farther, before it is in the way
constexpr double slack = 0.25; // what moves along a wall may lose of the distance by rounding

// Planes are pushed apart by 1 / sine of their angle; beyond this they are taken as parallel.
constexpr double least_square_of_sine = 1e-5;
constexpr double least_sine = 1e-3; // of lines in a plane

const glm::dvec3& corner(const Surface& surface, uint32_t face, uint32_t i)
{
    return surface.vertices[surface.faces[face].vertex[i]];
}

glm::dvec3 inward(const Surface& surface, uint32_t face, uint32_t i)
{
    return glm::normalize(
        glm::cross(surface.faces[face].normal, corner(surface, face, next(i)) - corner(surface, face, i)));
}

// How far a place beside the face's plane is within its outline; negative outside.
double within_outline(const Surface& surface, uint32_t face, const glm::dvec3& at)
{
    double nearest = INFINITY;
    for (uint32_t i = 0; i < 3; ++i)
        nearest = std::min(nearest, glm::dot(inward(surface, face, i), at - corner(surface, face, i)));
    return nearest;
}

bool is_wall_of(const Surface& surface, uint32_t face, uint32_t other)
{
    const Face& data = surface.faces[face];
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k)
        if (surface.pierced_by[k] == other) return true;
    return false;
}

// Whether another wall of the face falls away over this edge of the wall.
bool is_ridge(const Surface& surface, uint32_t face, uint32_t wall, uint32_t side, uint32_t edge)
{
    const SideEdge link = surface.faces[wall].link[edge][side];
    if (link.face() == wall) return false; // a border
    const glm::dvec3& tip = corner(surface, link.face(), previous(link.edge()));
    return glm::dot(tip - corner(surface, wall, edge), surface.facet_normal(wall, side)) < 0 &&
           is_wall_of(surface, face, link.face());
}

// Whether the place lies past a ridge of this side of the wall, before the wall there.
bool is_past_ridge(const Surface& surface, uint32_t face, uint32_t wall, uint32_t side, const glm::dvec3& at)
{
    for (uint32_t i = 0; i < 3; ++i) {
        if (glm::dot(inward(surface, wall, i), at - corner(surface, wall, i)) >= 0) continue;
        const SideEdge link = surface.faces[wall].link[i][side];
        if (glm::dot(at - corner(surface, wall, i), surface.facet_normal(link.face(), link.side())) >= 0 &&
            is_ridge(surface, face, wall, side, i))
            return true;
    }
    return false;
}

// Whether the way leads from beside a ridge of the wall away over it, to where the other wall of the ridge holds.
bool leaves_over_ridge(const Surface& surface, uint32_t face, uint32_t wall, uint32_t side, const glm::dvec3& from,
                       const glm::dvec3& to)
{
    for (uint32_t i = 0; i < 3; ++i) {
        const glm::dvec3 in = inward(surface, wall, i);
        if (glm::dot(in, from - corner(surface, wall, i)) < beside_wall && glm::dot(in, to - from) < 0 &&
            is_ridge(surface, face, wall, side, i))
            return true;
    }
    return false;
}

// Whether a wall of the face stands in the straight way: exact but for the ends, which are rounded to the lattice.
bool blocked(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to)
{
    const Face& data = surface.faces[face];
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        Crossing crossing;
        const uint32_t wall = surface.pierced_by[k];
        if (crosses(glm::round(from), glm::round(to), corner(surface, wall, 0), corner(surface, wall, 1),
                    corner(surface, wall, 2), crossing))
            return true;
    }
    return false;
}

// In a plane, what lies at least `least` along a unit vector from a place.
struct HalfPlane {
    glm::dvec3 inward{0};
    double least = 0, slack = 0;
    bool exactly = false; // and no more

    bool holds(const glm::dvec3& way) const
    {
        const double along = glm::dot(way, inward) - least;
        return along >= -slack && (!exactly || along <= slack);
    }
};

// The shortest way in the plane to where all of them hold: to none of their lines, to one, or to where two cross.
// False: there is none.
bool shortest_way(const std::array<HalfPlane, PlaneSet::most + 3>& half_planes, uint32_t count,
                  const glm::dvec3& normal, glm::dvec3& way)
{
    double shortest = INFINITY;
    const auto offer = [&](const glm::dvec3& candidate) {
        const double length = glm::length(candidate);
        if (length < shortest &&
            std::all_of(
                half_planes.begin(), half_planes.begin() + count, [&](const auto& p) { return p.holds(candidate); })) {
            shortest = length;
            way = candidate;
        }
    };
    offer(glm::dvec3(0));
    for (uint32_t j = 0; j < count; ++j) {
        const HalfPlane& one = half_planes[j];
        offer(one.least * one.inward);
        for (uint32_t i = 0; i < j; ++i) {
            const HalfPlane& other = half_planes[i];
            const glm::dvec3 across = glm::cross(normal, other.inward);
            const double sine = glm::dot(one.inward, across);
            if (std::abs(sine) < least_sine) continue;
            offer((one.least * across - other.least * glm::cross(normal, one.inward)) / sine);
        }
    }
    return shortest < INFINITY;
}

// Moves the place, which is in the face's plane, off the planes and into the face's outline, and beside the plane
// `along`, if any. False: they leave no room.
bool keep_off(const Surface& surface, uint32_t face, const PlaneSet& planes, uint32_t along, glm::dvec3& place)
{
    const glm::dvec3& front = surface.faces[face].normal;
    std::array<HalfPlane, PlaneSet::most + 3> half_planes;
    uint32_t count = 0;
    const auto away_from = [&](uint32_t k) {
        return glm::dot(place - corner(surface, planes.plane[k].face, 0), planes.plane[k].normal);
    };
    for (uint32_t k = 0; k < planes.count; ++k) {
        bool kept_off = false; // by another plane of the same body
        for (uint32_t other = 0; other < planes.count && !kept_off; ++other)
            kept_off = other != k && planes.body[other] == planes.body[k] && away_from(other) >= distance - slack;
        if (kept_off && k != along) continue;
        const Plane& plane = planes.plane[k];
        const double away = away_from(k);
        const glm::dvec3 within = plane.normal - glm::dot(plane.normal, front) * front;
        const double square = glm::dot(within, within);
        if (square >= least_square_of_sine) {
            const double sine = std::sqrt(square);
            half_planes[count++] = {within / sine, (distance - away) / sine, slack / sine, k == along};
        } else if (away <= -slack) { // else another triangle of the same plane
            return false;
        }
    }
    for (uint32_t i = 0; i < 3; ++i) {
        const glm::dvec3 in = inward(surface, face, i);
        half_planes[count++] = {in, glm::dot(in, corner(surface, face, i) - place), slack, false};
    }
    glm::dvec3 way;
    if (!shortest_way(half_planes, count, front, way)) return false;
    place += way;
    return true;
}

} // namespace

void add_walls(const Surface& surface, uint32_t face, const glm::dvec3& at, PlaneSet& planes) noexcept
{
    const Face& data = surface.faces[face];
    const uint32_t first = planes.count;
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        const uint32_t wall = surface.pierced_by[k];
        const double height = glm::dot(at - corner(surface, wall, 0), surface.faces[wall].normal);
        if (std::abs(height) > beside_wall || within_outline(surface, wall, at) < -margin - notice) continue;
        const uint32_t side = height >= 0 ? 0 : 1;
        if (is_past_ridge(surface, face, wall, 1 - side, at)) continue; // it only seems to be behind the wall
        planes.add({wall, side, surface.facet_normal(wall, side), false});
    }
    for (uint32_t k = first; k < planes.count; ++k) {
        const Plane& wall = planes.plane[k];
        for (uint32_t i = 0; i < 3; ++i) {
            if (!is_ridge(surface, face, wall.face, wall.side, i)) continue;
            const SideEdge link = surface.faces[wall.face].link[i][wall.side];
            for (uint32_t other = first; other < planes.count; ++other)
                if (planes.plane[other].face == link.face() && planes.plane[other].side == link.side())
                    planes.join(k, other);
        }
    }
}

ConeProjection project_on_cone(const PlaneSet& planes, const glm::dvec3& way) noexcept
{
    const double tolerance = 1e-15 * glm::length(way); // rounding: below 0.01 units
    const auto before = [&](uint32_t k, const glm::dvec3& candidate) {
        return glm::dot(planes.plane[k].normal, candidate) >= -tolerance;
    };
    const auto feasible = [&](const glm::dvec3& candidate) {
        for (uint32_t k = 0; k < planes.count; ++k) {
            bool free = before(k, candidate);
            for (uint32_t other = 0; other < planes.count && !free; ++other)
                free = planes.body[other] == planes.body[k] && before(other, candidate);
            if (!free) return false;
        }
        return true;
    };
    // The projection onto a cone is the longest of the feasible projections onto the planes and lines that bound
    // it. Among equals one along the first plane: no need to leave it.
    if (feasible(way)) return {way, {}, 0};
    ConeProjection best{glm::dvec3(0), {}, 3};
    double longest = 0;
    const auto offer = [&](const ConeProjection& projection) {
        const double length = glm::length(projection.way) + (projection.plane[0] == 0 ? equal : 0.0);
        if (length <= longest || !feasible(projection.way)) return;
        best = projection;
        longest = length;
    };
    for (uint32_t i = 0; i < planes.count; ++i) {
        const glm::dvec3& n = planes.plane[i].normal;
        offer({way - glm::dot(way, n) * n, {i}, 1});
    }
    for (uint32_t j = 0; j < planes.count; ++j)
        for (uint32_t i = j + 1; i < planes.count; ++i) {
            const glm::dvec3 line = glm::cross(planes.plane[j].normal, planes.plane[i].normal);
            const double square = glm::dot(line, line);
            if (square > least_square_of_sine * least_square_of_sine)
                offer({glm::dot(way, line) / square * line, {j, i}, 2});
        }
    return best;
}

double share_before_walls(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to) noexcept
{
    const Face& data = surface.faces[face];
    double share = 1;
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        const uint32_t wall = surface.pierced_by[k];
        const glm::dvec3 &a = corner(surface, wall, 0), &n = surface.faces[wall].normal;
        double begin = glm::dot(from - a, n), end = glm::dot(to - a, n);
        const uint32_t side = begin >= 0 ? 0 : 1;
        if (begin < 0) begin = -begin, end = -end;
        if (end >= std::min(distance, begin - slack)) continue;
        if (begin < beside_wall && leaves_over_ridge(surface, face, wall, side, from, to)) continue;
        // The part of the way that is near the plane, and of that the part that is near the triangle.
        double enter = begin <= distance ? 0 : (begin - distance) / (begin - end);
        double leave = end >= -distance ? 1 : (begin + distance) / (begin - end);
        for (uint32_t i = 0; i < 3; ++i) {
            const glm::dvec3 in = inward(surface, wall, i);
            const double first = glm::dot(in, from - corner(surface, wall, i)) + margin;
            const double last = glm::dot(in, to - corner(surface, wall, i)) + margin;
            if (first < 0 && last < 0) leave = -1;
            if (first < 0 && last >= 0) enter = std::max(enter, first / (first - last));
            if (first >= 0 && last < 0) leave = std::min(leave, first / (first - last));
        }
        if (enter <= leave) share = std::min(share, enter);
    }
    return share > 0 && blocked(surface, face, from, from + share * (to - from)) ? 0 : share;
}

bool stays_before_walls(const Surface& surface, uint32_t face, const glm::dvec3& from, const glm::dvec3& to) noexcept
{
    const Face& data = surface.faces[face];
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        const uint32_t wall = surface.pierced_by[k];
        const glm::dvec3 &a = corner(surface, wall, 0), &n = surface.faces[wall].normal;
        const double begin = glm::dot(from - a, n), end = begin < 0 ? -glm::dot(to - a, n) : glm::dot(to - a, n);
        if (end < least && end < std::abs(begin) && within_outline(surface, wall, to) > -margin) return false;
    }
    return !blocked(surface, face, from, to);
}

glm::dvec3 off_walls(const Surface& surface, uint32_t face, const glm::dvec3& at) noexcept
{
    PlaneSet walls;
    add_walls(surface, face, at, walls);
    glm::dvec3 place = at;
    return keep_off(surface, face, walls, none, place) && !blocked(surface, face, at, place) ? place : at;
}

bool onto_wall(const Surface& surface, const PlaneSet& planes, uint32_t wall, uint32_t along, const glm::dvec3& at,
               glm::dvec3& place) noexcept
{
    const Plane& onto = planes.plane[wall];
    PlaneSet others;
    uint32_t beside_it = none;
    for (uint32_t k = 0; k < planes.count; ++k) {
        if (planes.plane[k].face == onto.face || planes.plane[k].is_ridge || planes.body[k] == planes.body[wall])
            continue;
        if (k == along) beside_it = others.count;
        others.add(planes.plane[k], PlaneSet::most + planes.body[k]);
    }
    place = at - glm::dot(at - corner(surface, onto.face, 0), onto.normal) * onto.normal;
    return keep_off(surface, onto.face, others, beside_it, place);
}

glm::dvec3 landing_off_walls(const Surface& surface, const Crossing& landing, const glm::dvec3& from,
                             const glm::dvec3& to, const glm::dvec3& point) noexcept
{
    const Face& data = surface.faces[landing.face];
    PlaneSet walls;
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        const uint32_t wall = surface.pierced_by[k];
        if (within_outline(surface, wall, point) < -margin) continue;
        const glm::dvec3 &a = corner(surface, wall, 0), &b = corner(surface, wall, 1), &c = corner(surface, wall, 2);
        // The way may have passed the wall's plane beside the wall.
        Crossing passing;
        passing.face = wall;
        const bool passed = crosses_plane(from, to, a, b, c, passing) && earlier(passing, landing);
        const uint32_t side = side_of_plane(a, b, c, passed ? to : from) > 0 ? 0 : 1;
        const Plane plane{wall, side, surface.facet_normal(wall, side), false};
        if (std::abs(glm::dot(point - a, plane.normal)) < distance) walls.add(plane);
    }
    glm::dvec3 place = point;
    return keep_off(surface, landing.face, walls, none, place) ? place : point;
}

} // namespace haptel::runtime
