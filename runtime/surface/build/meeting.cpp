// Two triangles come nearest to each other where an edge of one comes nearest to the other, so that it is enough to
// hold the edges of each surface against the faces of the other, in the other's lattice.
#include "runtime/surface/build/meeting.h"

#include "runtime/geometry/nearest_point.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/corner.h"

#include <algorithm>

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

// Sees whether the edge comes near to a face.
class FacesNear final : public BallVisitor {
public:
    FacesNear(const Surface& surface, double gap, BuildWork& work) : surface_(surface), gap_(gap), work_(work) {}

    bool any(const Segment& edge)
    {
        edge_ = edge;
        reach_ = 0.5 * glm::distance(edge.from, edge.to) + gap_;
        surface_.tree->ball(edge.at(0.5), reach_, *this);
        return found_;
    }
    double visit(uint32_t face) noexcept override
    {
        const auto& v = surface_.faces[face].vertex;
        found_ = is_near(edge_, {surface_.vertices[v[0]], surface_.vertices[v[1]], surface_.vertices[v[2]]}, gap_);
        return !found_ && work_.spend() ? reach_ : 0;
    }

private:
    const Surface& surface_;
    double gap_;
    BuildWork& work_;
    Segment edge_{};
    double reach_ = 0;
    bool found_ = false;
};

bool edges_meet_faces(const Surface& edges, const Placement& of_edges, const Surface& faces, const Placement& of_faces,
                      double gap_m, BuildWork& work)
{
    const double gap = gap_m / faces.lattice.unit_m;
    FacesNear near(faces, gap, work);
    for (const Face& face : edges.faces) {
        if (!work.spend()) return false;
        glm::dvec3 corner[3];
        for (uint32_t i = 0; i < 3; ++i)
            corner[i] = faces.lattice.units(
                of_faces.to_object(of_edges.to_world(edges.lattice.metres(edges.vertices[face.vertex[i]]))));
        const glm::dvec3 low = glm::min(glm::min(corner[0], corner[1]), corner[2]),
                         high = glm::max(glm::max(corner[0], corner[1]), corner[2]);
        if (glm::any(glm::greaterThan(low, faces.box_maximum + gap)) ||
            glm::any(glm::lessThan(high, faces.box_minimum - gap)))
            continue;
        for (uint32_t i = 0; i < 3; ++i)
            if (near.any({corner[i], corner[next(i)]})) return true;
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
