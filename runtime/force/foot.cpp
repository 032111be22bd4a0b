#include "runtime/force/foot.h"

#include "runtime/surface/corner.h"
#include "runtime/texture/shading.h"

#include <algorithm>
#include <cmath>

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

// Newton's steps double the digits: after one below this the next is less than 1e-12.
constexpr int steps_most = 8;
constexpr double step_settled = 1e-6, on_edge = 1e-10;

// Rises from 0 to 1 over 0 .. 1, and its derivative.
struct Rise {
    double value, slope;
    explicit Rise(double x) : value(0), slope(0)
    {
        x = std::clamp(x, 0.0, 1.0);
        value = x * x * (3 - 2 * x);
        slope = 6 * x * (1 - x);
    }
};

// The line through the hand, t lengths of its normal below its point; and what moves the hand there: by b, and against
// the normal by t.
struct OnLine {
    glm::dvec2 b{0};
    double t = 0;
    dvec3 normal{0}, u{0}, v{0}, across{0}; // across: u x v
    double per = 0;                         // 1 / (across . normal)
    bool found = false;
};

// By Newton's steps from b and t.
void find_line(const FacetLines& lines, const dvec3& hand, OnLine& at) noexcept
{
    at.found = false;
    for (int step = 0; step < steps_most; ++step) {
        at.normal = lines.normal(at.b);
        at.u = lines.p[1] - at.t * lines.n[1];
        at.v = lines.p[2] - at.t * lines.n[2];
        at.across = cross(at.u, at.v);
        at.per = 1 / dot(at.across, at.normal);
        const dvec3 off = hand - lines.point(at.b) + at.t * at.normal, by_normal = cross(off, at.normal);
        const glm::dvec2 more(-at.per * dot(at.v, by_normal), at.per * dot(at.u, by_normal));
        at.b += more;
        const double back = at.per * dot(at.across, off);
        at.t -= back;
        const double size = std::fabs(more.x) + std::fabs(more.y) + std::fabs(back) / lines.edge_m;
        at.found = size < step_settled;
        if (at.found || !(size < facets_most)) return; // or not finite
    }
}

dvec3 weights(const glm::dvec2& b)
{
    return {1 - b.x - b.y, b.x, b.y};
}

// Over the edge, if the lines go on there: the same normals at both its ends.
bool cross_edge(const Surface& surface, uint32_t edge, uint32_t& face, uint32_t& side, dvec3& b) noexcept
{
    const SideEdge link = surface.faces[face].link[edge][side];
    if (link.face() == face) return false;
    const Face &here = surface.faces[face], &there = surface.faces[link.face()];
    const uint32_t from = edge, to = next(edge);
    const bool same_way = here.vertex[from] == there.vertex[link.edge()];
    const uint32_t from_there = same_way ? link.edge() : next(link.edge()),
                   to_there = same_way ? next(link.edge()) : link.edge();
    if (here.fan_or_part[from][side] != there.fan_or_part[from_there][link.side()] ||
        here.fan_or_part[to][side] != there.fan_or_part[to_there][link.side()])
        return false;
    const double of_from = std::max(0.0, b[from]), of_to = std::max(0.0, b[to]), sum = of_from + of_to;
    b = dvec3(0);
    b[from_there] = sum > 0 ? of_from / sum : 0.5;
    b[to_there] = 1 - b[from_there];
    face = link.face();
    side = link.side();
    return true;
}

// From a face that the line leaves over the edge before the corner of the least weight, or over another one.
bool go_on(const Surface& surface, uint32_t least, uint32_t& face, uint32_t& side, dvec3& b) noexcept
{
    if (cross_edge(surface, next(least), face, side, b)) return true;
    for (const uint32_t other : {next(least), previous(least)})
        if (b[other] < -on_edge && cross_edge(surface, next(other), face, side, b)) return true;
    return false;
}

} // namespace

Foot flat_foot(const Contact& contact) noexcept
{
    Foot foot;
    foot.face = contact.face;
    foot.side = contact.side;
    foot.barycentric = contact.barycentric;
    foot.at_m = contact.proxy_m;
    foot.depth_m = contact.depth_m;
    foot.way = foot.normal = foot.push = contact.normal;
    foot.edge_m[0] = dvec3(0);
    foot.share = 1;
    foot.share_dp = dvec3(0);
    return foot;
}

Foot paper_foot(const Surface& surface, const Contact& contact) noexcept
{
    Foot foot = flat_foot(contact);
    foot.normal = foot.push = shading_normal(surface, contact.face, contact.side, contact.barycentric);
    return foot;
}

Foot smooth_foot(const Surface& surface, const Contact& contact, const dvec3& hand_m, double held_above_m,
                 FacetLines& last) noexcept
{
    Foot foot = flat_foot(contact);
    foot.share = 0;
    uint32_t face = contact.face, side = contact.side;
    dvec3 b = contact.barycentric;
    OnLine at;
    at.t = contact.depth_m - held_above_m;
    for (int facet = 0; facet < facets_most; ++facet) {
        if (face != last.face || side != last.side) last = FacetLines(surface, face, side);
        const FacetLines& lines = last;
        if (lines.flat && facet == 0 && contact.normal == contact.facet_normal && lines.sunk_m == dvec3(0)) {
            foot.share = 1;
            return foot;
        }
        at.b = {b.y, b.z};
        find_line(lines, hand_m, at);
        if (!at.found) return foot;
        b = weights(at.b);
        const uint32_t least = b.x < b.y ? (b.x < b.z ? 0 : 2) : (b.y < b.z ? 1 : 2);
        const bool beyond = b[least] < -on_edge;
        if (beyond && go_on(surface, least, face, side, b)) continue;
        if (!(b[least] > -beyond_most)) return foot;

        const double length = glm::length(at.normal);
        const double open = dot(lines.area, at.normal);
        if (!(length > Surface::least_normal) || !((side ? -open : open) > 0)) return foot;

        const dvec3 second_dp = at.per * cross(at.v, at.normal), third_dp = at.per * cross(at.normal, at.u),
                    t_dp = -at.per * at.across;
        const auto by_hand = [&](const dvec3& of_corners) { // of what is linear between corners
            return (of_corners.y - of_corners.x) * second_dp + (of_corners.z - of_corners.x) * third_dp;
        };
        const double below = at.t * length, longer = at.t / length; // the normal's length changes, too
        const dvec3 below_dp = length * t_dp + longer * dot(at.normal, lines.n[1]) * second_dp +
                               longer * dot(at.normal, lines.n[2]) * third_dp;

        // How near its centre of curvature the hand is, whether the lines stand upright, and how far it is beyond them.
        const dvec3& bent_per_m = below > 0 ? lines.bent_in_per_m : lines.bent_out_per_m;
        const double away = std::fabs(below), bent = dot(bent_per_m, b);
        const Rise from_centre((at_centre - away * bent) / (at_centre - near_centre)),
            upright(2 * dot(lines.upright, b) - 1), within(1 + std::min(0.0, b[least]) / beyond_most);
        foot.share = from_centre.value * upright.value * within.value;
        if (!(foot.share > 0)) {
            foot.share = 0;
            return foot;
        }
        if (foot.share < 1) {
            const dvec3 nearer_dp = (below > 0 ? bent : -bent) * below_dp + away * by_hand(bent_per_m);
            foot.share_dp = -upright.value * within.value * from_centre.slope / (at_centre - near_centre) * nearer_dp +
                            from_centre.value * within.value * upright.slope * 2.0 * by_hand(lines.upright);
            dvec3 corner(0);
            corner[least] = 1;
            if (b[least] < 0)
                foot.share_dp += from_centre.value * upright.value * within.slope / beyond_most * by_hand(corner);
        }

        const FacetLines::Height s = lines.raised(b);
        const double depth = below + held_above_m, sunk = std::max(0.0, dot(lines.sunk_m, b));
        double by_depth = 1, by_sunk = 0;
        foot.depth_m = depth + s.m;
        if (sunk > 0 && depth < rises_within * sunk) {
            const Rise risen(depth / (rises_within * sunk));
            foot.depth_m -= (1 - risen.value) * sunk;
            by_depth += risen.slope / rises_within;
            by_sunk = 1 - risen.value + risen.slope * std::max(0.0, depth) / (rises_within * sunk);
        }
        foot.push = by_sunk * by_hand(lines.sunk_m) - by_depth * below_dp - s.db.x * second_dp - s.db.y * third_dp;
        foot.way = foot.normal = at.normal / length;

        foot.face = face;
        foot.side = side;
        foot.barycentric = b;
        foot.edge_m[0] = lines.p[1];
        foot.edge_m[1] = lines.p[2];
        foot.weight_dp[0] = second_dp;
        foot.weight_dp[1] = third_dp;
        if (beyond) { // the texture is that of the border
            foot.barycentric = glm::max(b, 0.0);
            const double all = foot.barycentric.x + foot.barycentric.y + foot.barycentric.z;
            foot.barycentric /= all;
            const dvec3 b_dp[] = {-second_dp - third_dp, second_dp, third_dp};
            dvec3 kept_dp[3], all_dp(0);
            for (uint32_t i = 0; i < 3; ++i) all_dp += kept_dp[i] = b[i] > 0 ? b_dp[i] : dvec3(0);
            for (uint32_t i : {0u, 1u}) foot.weight_dp[i] = (kept_dp[i + 1] - foot.barycentric[i + 1] * all_dp) / all;
        }
        foot.at_m = lines.point({foot.barycentric.y, foot.barycentric.z});
        return foot;
    }
    return foot;
}

} // namespace haptel::runtime
