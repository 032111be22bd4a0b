#include "runtime/force/foot.h"

#include "runtime/surface/corner.h"
#include "runtime/texture/shading.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

using glm::cross;
using glm::dmat3;
using glm::dot;
using glm::dvec3;

// Where the lines have come so much nearer to each other (by area) than at the surface, the flat foot begins to be
// felt, and alone. On a ball that is at 0.37 and 0.68 of its radius, under a ridge at 0.6 and 0.9.
constexpr double narrow = 0.4, narrowest = 0.1;

// Beyond a border or a crease the lines are those of the facet before it, up to so many times its height.
constexpr double beyond_most = 0.5;

// Down to so many times s the depth grows from that below the facet to that below the smooth surface. No spring is
// harder by more than 1.5 / 4.
constexpr double raised_within = 4;

// At less than the focal depth the foot is nearer to the flat one than half an edge.
constexpr int facets_most = 8;

// Newton's steps double the digits; that below which the next is lost in rounding.
constexpr int steps_most = 8;
constexpr double step_settled = 1e-8, on_edge = 1e-10;

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

// A facet and the lines through it. Derivatives are by the weights of the second and the third corner.
struct Lines {
    dvec3 p[3], n[3]; // of the corners, n[0] toward the side that is seen; p[1], p[2], n[1], n[2] from the first one

    Lines(const Surface& surface, uint32_t face, uint32_t side)
    {
        const auto& of_corner = surface.faces[face].fan_or_part;
        for (uint32_t i = 0; i < 3; ++i) {
            p[i] = surface.vertex_m(face, i);
            n[i] = surface.shading_normal(of_corner[i][side]);
        }
        for (uint32_t i : {1u, 2u}) p[i] -= p[0], n[i] -= n[0];
    }
    dvec3 point(const glm::dvec2& b) const { return p[0] + b.x * p[1] + b.y * p[2]; }
    dvec3 normal(const glm::dvec2& b) const { return n[0] + b.x * n[1] + b.y * n[2]; } // not of unit length
};

// The line of the hand, and how many lengths of the normal it is below its point there.
struct OnLine {
    glm::dvec2 b{0};
    double t = 0;
    bool found = false;
};

OnLine line_through(const Lines& lines, const dvec3& hand, OnLine at) noexcept
{
    at.found = false;
    for (int step = 0; step < steps_most; ++step) {
        const dvec3 n = lines.normal(at.b), off = hand - lines.point(at.b) + at.t * n;
        const dvec3 u = lines.p[1] - at.t * lines.n[1], v = lines.p[2] - at.t * lines.n[2];
        const dvec3 across = cross(u, v), by_n = cross(off, n);
        const double per = 1 / dot(across, n);
        const glm::dvec2 more(-per * dot(v, by_n), per * dot(u, by_n));
        at.b += more;
        at.t -= per * dot(across, off);
        const double size = std::fabs(more.x) + std::fabs(more.y);
        if (size < step_settled) {
            at.found = true;
            break;
        }
        if (!(size < facets_most)) break; // or not finite
    }
    return at;
}

struct Height {
    double m = 0;
    glm::dvec2 db{0};
};

// s: of the smooth surface above the facet.
Height raised(const Lines& lines, const dvec3& b) noexcept
{
    Height s;
    double db[3] = {}, bubble = 0;
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t j = next(i);
        const dvec3 edge = (j ? lines.p[j] : dvec3(0)) - (i ? lines.p[i] : dvec3(0));
        const dvec3 from = i ? lines.n[0] + lines.n[i] : lines.n[0], to = j ? lines.n[0] + lines.n[j] : lines.n[0];
        const double rise = -dot(from, edge), back = dot(to, edge); // slopes at both ends, each away from its corner
        const double mean = b[i] * rise + b[j] * back;
        s.m += b[i] * b[j] * mean;
        db[i] += b[j] * (mean + b[i] * rise);
        db[j] += b[i] * (mean + b[j] * back);
        bubble += 0.5 * (rise + back);
    }
    // So that what is quadratic is met.
    s.m += bubble * b[0] * b[1] * b[2];
    for (uint32_t i = 0; i < 3; ++i) db[i] += bubble * b[next(i)] * b[previous(i)];
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
    foot.at_dp = dmat3(1) - glm::outerProduct(contact.normal, contact.normal);
    return foot;
}

Foot paper_foot(const Surface& surface, const Contact& contact) noexcept
{
    Foot foot = flat_foot(contact);
    foot.normal = foot.push = shading_normal(surface, contact.face, contact.side, contact.barycentric);
    foot.at_dp = dmat3(1) - glm::outerProduct(foot.normal, foot.normal);
    return foot;
}

Foot smooth_foot(const Surface& surface, const Contact& contact, double held_above_m) noexcept
{
    Foot foot;
    foot.share = 0;
    const dvec3 hand = contact.proxy_m + (held_above_m - contact.depth_m) * contact.normal;
    uint32_t face = contact.face, side = contact.side;
    dvec3 b = contact.barycentric;
    double t = contact.depth_m - held_above_m;
    for (int facet = 0; facet < facets_most; ++facet) {
        const Lines lines(surface, face, side);
        const OnLine at = line_through(lines, hand, {{b.y, b.z}, t});
        if (!at.found) return foot;
        b = weights(at.b);
        t = at.t;
        const uint32_t least = b.x < b.y ? (b.x < b.z ? 0 : 2) : (b.y < b.z ? 1 : 2);
        const bool beyond = b[least] < -on_edge;
        if (beyond && go_on(surface, least, face, side, b)) continue;
        if (!(b[least] > -beyond_most)) return foot;

        const dvec3 sum = lines.normal(at.b);
        const double length = glm::length(sum);
        const dvec3 of_facet = cross(lines.p[1], lines.p[2]);
        const double open = dot(of_facet, sum);
        if (!(length > Surface::least_normal) || !((side ? -open : open) > 0)) return foot;
        const dvec3 n = sum / length;

        // How b and the way along n change with the hand, in a base of the offset facet's edges and n.
        const double below = t * length;
        const auto turn = [&](const dvec3& change) { return (change - dot(change, n) * n) / length; };
        const dvec3 u = lines.p[1] - below * turn(lines.n[1]), v = lines.p[2] - below * turn(lines.n[2]);
        const dvec3 across = cross(u, v);
        const double per = 1 / dot(across, n);
        const dvec3 second_dp = per * cross(v, n), third_dp = per * cross(n, u), below_dp = -per * across;
        const dvec3 b_dp[] = {-second_dp - third_dp, second_dp, third_dp};

        const Height s = raised(lines, b);
        const double depth = below + held_above_m;
        double by_s = 1, by_depth = 1;
        foot.depth_m = depth + s.m;
        if (s.m > 0 && depth < raised_within * s.m) {
            const Rise rise(depth / (raised_within * s.m));
            foot.depth_m = depth + rise.value * s.m;
            by_depth = 1 + rise.slope / raised_within;
            by_s = depth > 0 ? rise.value - rise.slope * depth / (raised_within * s.m) : 0;
        }
        foot.push = -by_depth * below_dp - by_s * (s.db.x * second_dp + s.db.y * third_dp);
        foot.way = foot.normal = glm::normalize(foot.push);
        foot.lag_m = contact.lag_m - dot(contact.lag_m, foot.normal) * foot.normal;

        // How near the lines have come to each other, as a polynomial of b and t.
        const dvec3 j = lines.p[1] - t * lines.n[1], k = lines.p[2] - t * lines.n[2], area = cross(j, k);
        const double left = dot(area, sum) / open;
        const Rise apart((left - narrowest) / (narrow - narrowest)), near(1 + std::min(0.0, b[least]) / beyond_most);
        foot.share = apart.value * near.value;
        if (foot.share < 1) {
            const auto left_db = [&](const dvec3& dn) { return (dot(area, dn) - left * dot(of_facet, dn)) / open; };
            const double left_dt = -dot(cross(lines.n[1], k) + cross(j, lines.n[2]), sum) / open;
            const dvec3 t_dp = -area / dot(area, sum);
            const dvec3 left_dp = left_db(lines.n[1]) * second_dp + left_db(lines.n[2]) * third_dp + left_dt * t_dp;
            foot.share_dp = near.value * apart.slope / (narrow - narrowest) * left_dp;
            if (b[least] < 0) foot.share_dp += apart.value * near.slope / beyond_most * b_dp[least];
        }

        foot.face = face;
        foot.side = side;
        foot.barycentric = b;
        dvec3 at_dp[] = {b_dp[0], b_dp[1], b_dp[2]};
        if (beyond) { // the texture is that of the border
            foot.barycentric = glm::max(b, 0.0);
            const double all = foot.barycentric.x + foot.barycentric.y + foot.barycentric.z;
            foot.barycentric /= all;
            dvec3 all_dp(0);
            for (uint32_t i = 0; i < 3; ++i) all_dp += at_dp[i] = b[i] > 0 ? b_dp[i] : dvec3(0);
            for (uint32_t i = 0; i < 3; ++i) at_dp[i] = (at_dp[i] - foot.barycentric[i] * all_dp) / all;
        }
        foot.at_m = lines.point({foot.barycentric.y, foot.barycentric.z});
        foot.at_dp = glm::outerProduct(lines.p[1], at_dp[1]) + glm::outerProduct(lines.p[2], at_dp[2]);
        return foot;
    }
    return foot;
}

} // namespace haptel::runtime
