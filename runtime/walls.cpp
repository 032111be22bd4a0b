#include "runtime/walls.h"

#include "runtime/fan.h"
#include "runtime/predicates.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr double distance = 16; // of the proxy from a wall's plane; rounding is below 1
constexpr double least = 4;     // that is left of it after a step aside
constexpr double beside = 64;   // nearer than this is beside it: less is not worth going
constexpr double equal = 1;     // lengths of ways that differ by less are
constexpr uint32_t none = ~0u;
constexpr double margin = 8; // so far a wall reaches beyond its outline; less than where the wall behind a ridge begins
constexpr double slack = 0.25; // what moves along a wall may lose of the distance by rounding

// Sheets are pushed apart by 1 / sine of their angle; beyond this they are taken as parallel.
constexpr double least_square_of_sine = 1e-5;

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

// Moves the place, which is in the face's plane, off the sheets and into the face's outline, and beside the sheet
// `along`, if any: by turns, since few are concerned. False: that does not end, they leave no room.
bool keep_off(const Surface& surface, uint32_t face, const Cell& sheets, uint32_t along, glm::dvec3& place)
{
    const glm::dvec3& front = surface.faces[face].normal;
    for (int round = 0; round < 24; ++round) {
        bool moved = false;
        for (uint32_t k = 0; k < sheets.count; ++k) {
            const Sheet& sheet = sheets.sheet[k];
            const double away = glm::dot(place - corner(surface, sheet.face, 0), sheet.normal);
            if (away >= distance - slack && (k != along || away <= distance + slack)) continue;
            const glm::dvec3 within = sheet.normal - glm::dot(sheet.normal, front) * front;
            const double square = glm::dot(within, within);
            if (square < least_square_of_sine) {
                if (away > -slack) continue; // another triangle of the same plane
                return false;
            }
            place += (distance - away) / square * within;
            moved = true;
        }
        for (uint32_t i = 0; i < 3; ++i) {
            const glm::dvec3 in = inward(surface, face, i);
            const double inside = glm::dot(in, place - corner(surface, face, i));
            if (inside >= -slack) continue;
            place -= inside * in;
            moved = true;
        }
        if (!moved) return true;
    }
    return false;
}

} // namespace

void add_walls(const Surface& surface, uint32_t face, const glm::dvec3& at, Cell& cell) noexcept
{
    const Face& data = surface.faces[face];
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        const uint32_t wall = surface.pierced_by[k];
        const double height = glm::dot(at - corner(surface, wall, 0), surface.faces[wall].normal);
        if (std::abs(height) > beside || within_outline(surface, wall, at) < -margin - slack) continue;
        const uint32_t side = height >= 0 ? 0 : 1;
        cell.add({wall, side, surface.facet_normal(wall, side), false});
    }
}

Descent steepest(const Cell& cell, const glm::dvec3& way) noexcept
{
    const double tolerance = 1e-15 * glm::length(way); // rounding: below 0.01 units
    const auto feasible = [&](const glm::dvec3& candidate) {
        for (uint32_t k = 0; k < cell.count; ++k)
            if (glm::dot(cell.sheet[k].normal, candidate) < -tolerance) return false;
        return true;
    };
    // The projection onto a cone is the longest of the feasible projections onto the planes and lines that bound it.
    // Among equals one along the first sheet: no need to leave it.
    if (feasible(way)) return {way, {}, 0};
    Descent best{glm::dvec3(0), {}, 3};
    double longest = 0;
    const auto offer = [&](const Descent& descent) {
        const double length = glm::length(descent.way) + (descent.sheet[0] == 0 ? equal : 0.0);
        if (length <= longest || !feasible(descent.way)) return;
        best = descent;
        longest = length;
    };
    for (uint32_t i = 0; i < cell.count; ++i) {
        const glm::dvec3& n = cell.sheet[i].normal;
        offer({way - glm::dot(way, n) * n, {i}, 1});
    }
    for (uint32_t j = 0; j < cell.count; ++j)
        for (uint32_t i = j + 1; i < cell.count; ++i) {
            const glm::dvec3 line = glm::cross(cell.sheet[j].normal, cell.sheet[i].normal);
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
        if (begin < 0) begin = -begin, end = -end;
        if (end >= std::min(distance, begin - slack)) continue;
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
    Cell walls;
    add_walls(surface, face, at, walls);
    glm::dvec3 place = at;
    return keep_off(surface, face, walls, none, place) && !blocked(surface, face, at, place) ? place : at;
}

bool onto_wall(const Surface& surface, const Cell& cell, uint32_t wall, uint32_t along, const glm::dvec3& at,
               glm::dvec3& place) noexcept
{
    const Sheet& onto = cell.sheet[wall];
    Cell others;
    uint32_t beside_it = none;
    for (uint32_t k = 0; k < cell.count; ++k) {
        if (cell.sheet[k].face == onto.face || cell.sheet[k].is_ridge) continue;
        if (k == along) beside_it = others.count;
        others.add(cell.sheet[k]);
    }
    place = at - glm::dot(at - corner(surface, onto.face, 0), onto.normal) * onto.normal;
    return keep_off(surface, onto.face, others, beside_it, place);
}

glm::dvec3 landing_off_walls(const Surface& surface, const Crossing& landing, const glm::dvec3& from,
                             const glm::dvec3& to, const glm::dvec3& point) noexcept
{
    const Face& data = surface.faces[landing.face];
    Cell walls;
    for (uint32_t k = data.pierced_begin; k < data.pierced_end; ++k) {
        const uint32_t wall = surface.pierced_by[k];
        if (within_outline(surface, wall, point) < -margin) continue;
        const glm::dvec3 &a = corner(surface, wall, 0), &b = corner(surface, wall, 1), &c = corner(surface, wall, 2);
        // The way may have passed the wall's plane beside the wall.
        Crossing passing;
        passing.face = wall;
        const bool passed = crosses_plane(from, to, a, b, c, passing) && earlier(passing, landing);
        const uint32_t side = side_of_plane(a, b, c, passed ? to : from) > 0 ? 0 : 1;
        const Sheet sheet{wall, side, surface.facet_normal(wall, side), false};
        if (std::abs(glm::dot(point - a, sheet.normal)) < distance) walls.add(sheet);
    }
    glm::dvec3 place = point;
    return keep_off(surface, landing.face, walls, none, place) ? place : point;
}

} // namespace haptel::runtime
