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

// Where the lines have come so much nearer to each other (by area) than at the surface, the flat foot begins to be
// felt, and alone. On a ball that is at 0.37 and 0.68 of its radius, under a ridge at 0.6 and 0.9.
constexpr double narrow = 0.4, narrowest = 0.1;

// Beyond a border or a crease the lines are those of the facet before it, up to so many times its height.
constexpr double beyond_most = 0.5;

// Down to so many times s the depth grows from that below the facet to that below the smooth surface. There the spring
// is harder, at most 1.63 times; within 4 times s it would be twice.
constexpr double raised_within = 6;

// At less than the focal depth the foot is nearer to the flat one than half an edge.
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
        at.t -= at.per * dot(at.across, off);
        const double size = std::fabs(more.x) + std::fabs(more.y);
        at.found = size < step_settled;
        if (at.found || !(size < facets_most)) return; // or not finite
    }
}

struct Height {
    double m = 0;
    glm::dvec2 db{0};
};

// s: of the smooth surface above the facet.
Height raised(const FacetLines& lines, const dvec3& b) noexcept
{
    Height s;
    double db[3] = {};
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t j = next(i);
        const double mean = b[i] * lines.rise[i] + b[j] * lines.back[i];
        s.m += b[i] * b[j] * mean;
        db[i] += b[j] * (mean + b[i] * lines.rise[i]);
        db[j] += b[i] * (mean + b[j] * lines.back[i]);
    }
    s.m += lines.bubble * b[0] * b[1] * b[2];
    for (uint32_t i = 0; i < 3; ++i) db[i] += lines.bubble * b[next(i)] * b[previous(i)];
    s.db = {db[1] - db[0], db[2] - db[0]};
    return s;
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

FacetLines::FacetLines(const Surface& surface, uint32_t of_face, uint32_t of_side) noexcept
    : face(of_face), side(of_side), bubble(0)
{
    const auto& of_corner = surface.faces[face].fan_or_part;
    for (uint32_t i = 0; i < 3; ++i) {
        p[i] = surface.vertex_m(face, i);
        n[i] = surface.shading_normal(of_corner[i][side]);
    }
    for (uint32_t i = 0; i < 3; ++i) {
        const dvec3 edge = p[next(i)] - p[i];
        rise[i] = -dot(n[i], edge);
        back[i] = dot(n[next(i)], edge);
        bubble += 0.5 * (rise[i] + back[i]); // so that what is quadratic is met
    }
    for (uint32_t i : {1u, 2u}) p[i] -= p[0], n[i] -= n[0];
    area = cross(p[1], p[2]);
}

Foot flat_foot(const Contact& contact) noexcept
{
    Foot foot;
    foot.face = contact.face;
    foot.side = contact.side;
    foot.barycentric = contact.barycentric;
    foot.at_m = contact.proxy_m;
    foot.depth_m = contact.depth_m;
    foot.way = foot.normal = foot.push = contact.normal;
    foot.lag_m = contact.lag_m;
    foot.edge_m[0] = dvec3(0);
    foot.share = 1;
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
    Foot foot;
    foot.share = 0;
    uint32_t face = contact.face, side = contact.side;
    dvec3 b = contact.barycentric;
    OnLine at;
    at.t = contact.depth_m - held_above_m;
    for (int facet = 0; facet < facets_most; ++facet) {
        if (face != last.face || side != last.side) last = FacetLines(surface, face, side);
        const FacetLines& lines = last;
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
        const dvec3 b_dp[] = {-second_dp - third_dp, second_dp, third_dp};
        // The normal's length changes, too.
        const double longer = at.t / length;
        const dvec3 below_dp = length * t_dp + longer * dot(at.normal, lines.n[1]) * second_dp +
                               longer * dot(at.normal, lines.n[2]) * third_dp;
        const Height s = raised(lines, b);
        const double depth = at.t * length + held_above_m;
        double by_s = 1, by_depth = 1;
        foot.depth_m = depth + s.m;
        if (s.m > 0 && depth < raised_within * s.m) {
            const Rise rise(depth / (raised_within * s.m));
            foot.depth_m = depth + rise.value * s.m;
            by_depth = 1 + rise.slope / raised_within;
            by_s = depth > 0 ? rise.value - rise.slope * depth / (raised_within * s.m) : 0;
        }
        foot.push = -by_depth * below_dp - by_s * (s.db.x * second_dp + s.db.y * third_dp);
        foot.way = foot.normal = at.normal / length;
        foot.lag_m = contact.lag_m - dot(contact.lag_m, foot.normal) * foot.normal;

        // How near the lines have come to each other: what is left of the facet's area, as a polynomial of b and t.
        const double left = 1 / (at.per * open);
        const Rise apart((left - narrowest) / (narrow - narrowest)), near(1 + std::min(0.0, b[least]) / beyond_most);
        foot.share = apart.value * near.value;
        if (foot.share < 1) {
            const auto left_db = [&](const dvec3& dn) {
                return (dot(at.across, dn) - left * dot(lines.area, dn)) / open;
            };
            const double left_dt = -dot(cross(lines.n[1], at.v) + cross(at.u, lines.n[2]), at.normal) / open;
            const dvec3 left_dp = left_db(lines.n[1]) * second_dp + left_db(lines.n[2]) * third_dp + left_dt * t_dp;
            foot.share_dp = near.value * apart.slope / (narrow - narrowest) * left_dp;
            if (b[least] < 0) foot.share_dp += apart.value * near.slope / beyond_most * b_dp[least];
        }

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
