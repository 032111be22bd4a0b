// Two triangles come nearest to each other where an edge of one comes nearest to the other, so that it is enough to
// hold the edges of each surface against the faces of the other, in the other's lattice.
#include "runtime/surface/build/meeting.h"

#include "runtime/geometry/nearest_point.h"
#include "runtime/surface/corner.h"
#include "runtime/surface/swept_region.h"

#include <algorithm>
#include <vector>

namespace haptel::runtime {

namespace {

struct Segment {
    glm::dvec3 from, to;
    glm::dvec3 at(double share) const { return from + share * (to - from); }
};

// Ericson 2005, Real-Time Collision Detection, 5.1.9.
double apart(const Segment& p, const Segment& q)
{
    const glm::dvec3 d = p.to - p.from, e = q.to - q.from, between = p.from - q.from;
    const double dd = glm::dot(d, d), ee = glm::dot(e, e), de = glm::dot(d, e);
    const double along_d = glm::dot(d, between), along_e = glm::dot(e, between), square = dd * ee - de * de;
    double s = square > 0 ? glm::clamp((de * along_e - along_d * ee) / square, 0.0, 1.0) : 0.0;
    const double t = glm::clamp((de * s + along_e) / ee, 0.0, 1.0);
    s = glm::clamp((de * t - along_d) / dd, 0.0, 1.0);
    return glm::distance(p.at(s), q.at(t));
}

// Whether it goes through the triangle within. Beside its edges and at its own ends it is near them.
bool crosses(const Segment& edge, const std::array<glm::dvec3, 3>& corner)
{
    const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double from = glm::dot(normal, edge.from - corner[0]), to = glm::dot(normal, edge.to - corner[0]);
    if ((from < 0) == (to < 0)) return false;
    const glm::dvec3 at = edge.at(from / (from - to));
    for (uint32_t i = 0; i < 3; ++i)
        if (glm::dot(glm::cross(normal, corner[next(i)] - corner[i]), at - corner[i]) < 0) return false;
    return true;
}

bool is_near(const Segment& edge, const std::array<glm::dvec3, 3>& corner, double gap)
{
    const auto off = [&](const glm::dvec3& p) {
        return glm::distance(p, nearest_point(corner[0], corner[1], corner[2], p).at);
    };
    if (off(edge.from) <= gap || off(edge.to) <= gap || crosses(edge, corner)) return true;
    for (uint32_t i = 0; i < 3; ++i)
        if (apart(edge, {corner[i], corner[next(i)]}) <= gap) return true;
    return false;
}

struct FaceBox {
    glm::dvec3 minimum, maximum;
};

// What of an edge is within the box. False: nothing.
bool clip(Segment& edge, const FaceBox& box)
{
    double begin = 0, end = 1;
    const glm::dvec3 along = edge.to - edge.from;
    for (int k = 0; k < 3; ++k) {
        const double low = box.minimum[k] - edge.from[k], high = box.maximum[k] - edge.from[k];
        if (along[k] == 0 && (low > 0 || high < 0)) return false;
        if (along[k] == 0) continue;
        begin = std::max(begin, std::min(low / along[k], high / along[k]));
        end = std::min(end, std::max(low / along[k], high / along[k]));
    }
    if (begin > end) return false;
    edge = {edge.at(begin), edge.at(end)};
    return true;
}

bool edges_meet_faces(const Surface& edges, const Placement& of_edges, const Surface& faces, const Placement& of_faces,
                      double gap_m, BuildWork& work)
{
    const double gap = gap_m / faces.lattice.unit_m;
    const FaceBox box{faces.lattice.units(faces.box_minimum_m) - gap, faces.lattice.units(faces.box_maximum_m) + gap};
    const glm::dvec3 middle = edges.lattice.units(
        of_edges.to_object(of_faces.to_world(faces.lattice.metres(0.5 * (box.minimum + box.maximum)))));
    const double radius = 0.5 * glm::distance(box.minimum, box.maximum) * faces.lattice.unit_m / edges.lattice.unit_m;
    std::vector<uint32_t> candidates;
    (void)edges.tree->ball(middle, radius, edges.faces.size(), candidates);
    for (const uint32_t candidate : candidates) {
        glm::dvec3 corner[3];
        for (uint32_t i = 0; i < 3; ++i)
            corner[i] = faces.lattice.units(of_faces.to_object(of_edges.to_world(edges.vertex_m(candidate, i))));
        for (uint32_t i = 0; i < 3; ++i) {
            if (!work.spend()) return false;
            Segment edge{corner[i], corner[next(i)]};
            if (!clip(edge, box)) continue;
            bool found = false;
            const auto looks_on = [&](uint32_t face) {
                found = is_near(edge, faces.corners(face), gap);
                return !found && work.spend();
            };
            (void)faces.tree->for_each(SweptRegion(edge.from, edge.to, edge.from, edge.to, gap), looks_on);
            if (found) return true;
        }
    }
    return false;
}

} // namespace

bool meet(const Surface& one, const Placement& of_one, const Surface& other, const Placement& of_other, double gap_m,
          BuildWork& work)
{
    return edges_meet_faces(one, of_one, other, of_other, gap_m, work) ||
           edges_meet_faces(other, of_other, one, of_one, gap_m, work);
}

} // namespace haptel::runtime
