#include "runtime/force/foot.h"

#include "runtime/geometry/rise.h"
#include "runtime/surface/corner.h"
#include "runtime/texture/shading.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace haptel::runtime {

namespace {

using glm::cross;
using glm::dot;
using glm::dvec3;

// Below the surface, of the least radius of curvature around: from here on the flat foot begins to be felt, and alone.
constexpr double near_centre = 0.5, at_centre = 0.8;

// Down to so many times as deep as the smooth surface is sunk it rises to its own place. There the spring is harder, at
// most 1.63 times; within 4 times it would be twice.
constexpr double rises_within = 6;

// Beyond a border or a crease the lines are those of the facet before it, up to so many times its height.
constexpr double beyond_most = 0.5;

// Above the centres of curvature the foot is mostly nearer to the flat one than half an edge.
constexpr int facets_most = 8;

// Steps are Chebyshev's until what one leaves is less than so much of an edge. Far away, where they would overshoot,
// they are Newton's.
constexpr int steps_most = 8;
constexpr double settled_within = 1e-12, bends_most = 0.25, on_edge = 1e-10;

// The line through the hand, t of its normal below its point.
struct OnLine {
    dvec3 b{0};
    double t = 0;
    dvec3 normal{0}, across{0}; // across: of the facet that the points t below span
    double per_m3 = 0;          // 1 / (across . normal)
};

// By steps from how deep below the facet's plane the hand is: the points t of their normals below the facet span
// another one, in whose plane the hand is where a cubic is 0. False where it finds none. Of the foot it fills how the
// weights change.
bool find_line(const FacetLines& lines, const dvec3& hand_m, OnLine& at, Foot& foot) noexcept
{
    const dvec3 from = hand_m - lines.p[0];
    const double c0 = dot(from, lines.area), c1 = lines.by_normal[0] - dot(from, lines.turn),
                 c2 = dot(from, lines.turn_dt) - lines.by_normal[1], c3 = lines.by_normal[2];
    double t = -c0 * lines.per_m2;
    bool settled = false;
    for (int step = 0; step < steps_most && !settled; ++step) {
        const double per = 1 / (c1 + t * (2 * c2 + t * 3 * c3)), more = per * (c0 + t * (c1 + t * (c2 + t * c3)));
        const double bends = more * per * (c2 + t * 3 * c3);
        t -= std::fabs(bends) < bends_most ? more + bends * more : more;
        const double left = 2 * bends * bends + std::fabs(per * c3) * more * more; // of this step
        settled = left * std::fabs(more) < settled_within * lines.edge_m;
    }
    at.t = t;
    at.per_m3 = 1 / (c1 + t * (2 * c2 + t * 3 * c3)); // at the line this is across . normal
    const dvec3 u = lines.p[1] - t * lines.n[1], v = lines.p[2] - t * lines.n[2];
    at.across = cross(u, v);
    const dvec3 off = cross(from + t * lines.n[0], lines.area);
    const double by_area = 1 / (lines.by_area[0] - t * (lines.by_area[1] - t * lines.by_area[2]));
    const double second = -by_area * dot(off, v), third = by_area * dot(off, u);
    at.b = {1 - second - third, second, third};
    at.normal = lines.normal({second, third});
    foot.line_m[0] = u;
    foot.line_m[1] = v;
    foot.turned_per_m2 = at.per_m3 * at.normal;
    return settled && std::fabs(second) + std::fabs(third) < facets_most; // and finite
}

// Over the edge, if the lines go on there: the same normals at both its ends.
bool cross_edge(const Surface& surface, uint32_t edge, uint32_t& face, uint32_t& side, dvec3& b) noexcept
{
    const auto from = smooth_neighbour(surface, {face, edge, side}, edge),
               to = smooth_neighbour(surface, {face, next(edge), side}, edge);
    if (!from || !to) return false;
    const double of_from = std::max(0.0, b[edge]), of_to = std::max(0.0, b[next(edge)]), sum = of_from + of_to;
    b = dvec3(0);
    b[from->corner] = sum > 0 ? of_from / sum : 0.5;
    b[to->corner] = 1 - b[from->corner];
    face = from->face;
    side = from->side;
    return true;
}

// From a face that the line leaves over the edge before the corner of the least weight, or over another one.
bool go_on(const Surface& surface, double of_least, uint32_t& face, uint32_t& side, dvec3& b) noexcept
{
    const uint32_t least = b.x == of_least ? 0 : b.y == of_least ? 1 : 2;
    if (cross_edge(surface, next(least), face, side, b)) return true;
    for (const uint32_t other : {next(least), previous(least)})
        if (b[other] < -on_edge && cross_edge(surface, next(other), face, side, b)) return true;
    return false;
}

// Fills `share`: how near its centre of curvature the hand is, whether the lines stand upright, how far it is beyond
// them.
void find_share(const FacetLines& lines, const OnLine& at, double least, double length, Foot& foot) noexcept
{
    const double below = at.t * length, away = std::fabs(below);
    const dvec3& bent_per_m = below > 0 ? lines.bent_in_per_m : lines.bent_out_per_m;
    const double bent = dot(bent_per_m, at.b);
    foot.share = 1;
    foot.share_dp = dvec3(0);
    if (away * bent <= near_centre && lines.upright == dvec3(1) && least >= 0) return;
    const Rise from_centre((at_centre - away * bent) / (at_centre - near_centre)),
        upright(2 * dot(lines.upright, at.b) - 1), within(1 + std::min(0.0, least) / beyond_most);
    foot.share = from_centre.value * upright.value * within.value;
    if (!(foot.share > 0)) {
        foot.share = 0;
        return;
    }
    const auto by_hand = [&](const dvec3& of_corners) { // of what is linear between corners
        return foot.by_weights(of_corners.y - of_corners.x, of_corners.z - of_corners.x);
    };
    const double longer = at.t / length;
    const dvec3 below_dp = foot.by_weights(longer * dot(at.normal, lines.n[1]), longer * dot(at.normal, lines.n[2])) -
                           length * at.per_m3 * at.across;
    const dvec3 nearer_dp = (below > 0 ? bent : -bent) * below_dp + away * by_hand(bent_per_m);
    foot.share_dp = -upright.value * within.value * from_centre.slope / (at_centre - near_centre) * nearer_dp +
                    from_centre.value * within.value * upright.slope * 2.0 * by_hand(lines.upright);
    if (least < 0)
        foot.share_dp += from_centre.value * upright.value * within.slope / beyond_most *
                         by_hand(dvec3(glm::equal(at.b, dvec3(least))));
}

// Fills `depth_m` and `push`.
void find_depth(const FacetLines& lines, const OnLine& at, double length, double held_above_m, Foot& foot) noexcept
{
    const FacetLines::Height s = lines.raised(at.b);
    const double depth = at.t * length + held_above_m, sunk = std::max(0.0, dot(lines.sunk_m, at.b));
    double by_depth = 1, by_sunk = 0;
    foot.depth_m = depth + s.m;
    if (sunk > 0 && depth < rises_within * sunk) {
        const Rise risen(depth / (rises_within * sunk));
        foot.depth_m -= (1 - risen.value) * sunk;
        by_depth += risen.slope / rises_within;
        by_sunk = 1 - risen.value + risen.slope * std::max(0.0, depth) / (rises_within * sunk);
    }
    const double longer = by_depth * at.t / length; // the normal's length changes, too
    const auto by_weight = [&](uint32_t corner, double raised_by) {
        return by_sunk * (lines.sunk_m[corner] - lines.sunk_m.x) - longer * dot(at.normal, lines.n[corner]) - raised_by;
    };
    foot.push = foot.by_weights(by_weight(1, s.db.x), by_weight(2, s.db.y)) + by_depth * length * at.per_m3 * at.across;
}

// Fills where the texture is felt: beyond a border as at it.
void find_place(const FacetLines& lines, const dvec3& b, bool beyond, Foot& foot) noexcept
{
    foot.face = lines.face;
    foot.side = lines.side;
    foot.barycentric = b;
    foot.edge_m[0] = lines.p[1];
    foot.edge_m[1] = lines.p[2];
    if (beyond) {
        const dvec3 kept(glm::greaterThan(b, dvec3(0)));
        const double all = dot(kept, b);
        foot.barycentric = kept * b / all;
        const dvec3 at = lines.point({foot.barycentric.y, foot.barycentric.z}) - lines.p[0], first = kept.x * -at;
        for (uint32_t i : {0u, 1u}) foot.edge_m[i] = (kept[i + 1] * (lines.p[i + 1] - at) - first) / all;
    }
    foot.at_m = lines.point({foot.barycentric.y, foot.barycentric.z});
}

// Of what holds the place: on an edge it goes along that alone, at a vertex nowhere.
void find_hold(const Surface& surface, const Contact& contact, Foot& foot) noexcept
{
    const dvec3& b = contact.barycentric;
    if (contact.rolls >= 0) {
        foot.across = contact.rolls;
        foot.line = contact.groove;
        return;
    }
    const int corners = (b.x > 0) + (b.y > 0) + (b.z > 0);
    if (corners == 3) return;
    foot.across = 0;
    if (corners < 2) return;
    const uint32_t off = b.x == 0 ? 0 : b.y == 0 ? 1 : 2;
    foot.line =
        glm::normalize(surface.vertex_m(contact.face, previous(off)) - surface.vertex_m(contact.face, next(off)));
}

} // namespace

Foot flat_foot(const Surface& surface, const Contact& contact) noexcept
{
    Foot foot;
    foot.face = contact.face;
    foot.side = contact.side;
    foot.barycentric = contact.barycentric;
    foot.at_m = contact.proxy_m;
    foot.depth_m = contact.depth_m;
    foot.way = foot.normal = foot.push = contact.normal;
    foot.turned_per_m2 = dvec3(0);
    foot.line = dvec3(0);
    foot.across = 1;
    if (glm::distance(contact.normal, contact.facet_normal) > one_place) find_hold(surface, contact, foot);
    foot.share = 1;
    foot.share_dp = dvec3(0);
    return foot;
}

namespace {

// False where nothing of it is felt.
bool find_foot(const Surface& surface, const Contact& contact, const dvec3& hand_m, FacetLines& lines,
               Foot& foot) noexcept
{
    uint32_t face = contact.face, side = contact.side;
    OnLine at;
    for (int facet = 0; facet < facets_most; ++facet) {
        if (face != lines.face || side != lines.side) std::construct_at(&lines, surface, face, side);
        if (lines.flat && facet == 0 && contact.normal == contact.facet_normal && lines.sunk_m == dvec3(0)) {
            foot = flat_foot(surface, contact);
            return true;
        }
        if (!find_line(lines, hand_m, at, foot)) return false;
        const double least = std::min({at.b.x, at.b.y, at.b.z}); // without branches, which nobody could foresee
        const bool beyond = least < -on_edge;
        if (beyond && go_on(surface, least, face, side, at.b)) continue;

        const double length = glm::length(at.normal), open = dot(lines.area, at.normal);
        if (!(least > -beyond_most) || !(length > Surface::least_normal) || !((side ? -open : open) > 0)) return false;
        find_share(lines, at, least, length, foot);
        if (foot.share == 0) return false;
        find_depth(lines, at, length, contact.radius_m, foot);
        foot.way = foot.normal = at.normal / length;
        foot.normal_length = length;
        find_place(lines, at.b, beyond, foot);
        return true;
    }
    return false;
}

} // namespace

Foot paper_foot(const Surface& surface, const Contact& contact) noexcept
{
    Foot foot = flat_foot(surface, contact);
    foot.normal = foot.push = shading_normal(surface, contact.face, contact.side, contact.barycentric);
    return foot;
}

Foot smooth_foot(const Surface& surface, const Contact& contact, const dvec3& hand_m, FacetLines& last) noexcept
{
    Foot foot;
    if (!find_foot(surface, contact, hand_m, last, foot)) {
        foot = flat_foot(surface, contact);
        foot.share = 0;
    }
    return foot;
}

glm::dmat3 turning(const FacetLines& lines, const Foot& foot) noexcept
{
    const auto across = [&](const dvec3& n) { return (n - dot(n, foot.normal) * foot.normal) / foot.normal_length; };
    return glm::outerProduct(across(lines.n[1]), foot.by_weights(1, 0)) +
           glm::outerProduct(across(lines.n[2]), foot.by_weights(0, 1));
}

} // namespace haptel::runtime
