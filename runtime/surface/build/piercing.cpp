#include "runtime/geometry/predicates.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/corner.h"

#include <algorithm>

namespace haptel::runtime {

namespace {

constexpr std::size_t looks_per_test = 8;

// Two faces that are not neighbours cut or touch each other exactly if an edge of one meets the other. Ties count
// as touching. A face in the plane of the edge cannot stop a path along it.
class EdgeAgainstFaces final : public SegmentVisitor {
public:
    EdgeAgainstFaces(const Surface& surface, BuildWork& work)
        : is_pierced(surface.faces.size()), surface_(surface), work_(work), is_done_(3 * surface.faces.size())
    {
    }

    // An edge once, with all the faces that have it.
    void run(uint32_t face, uint32_t edge)
    {
        if (is_done_[3 * face + edge]) return;
        faces_.clear();
        for (SideEdge at(face, edge, 0); !is_done_[3 * at.face() + at.edge()];) {
            is_done_[3 * at.face() + at.edge()] = true;
            faces_.push_back(at.face());
            const SideEdge next_face = surface_.faces[at.face()].link[at.edge()][at.side()];
            at = SideEdge(next_face.face(), next_face.edge(), 1 - next_face.side());
        }
        from_ = surface_.faces[face].vertex[edge];
        to_ = surface_.faces[face].vertex[next(edge)];
        surface_.tree->segment(surface_.vertices[from_], surface_.vertices[to_], *this);
    }

    double visit(uint32_t other) noexcept override
    {
        if (!work_.spend()) return 0;
        const auto& corners = surface_.faces[other].vertex;
        for (uint32_t corner : corners)
            if (corner == from_ || corner == to_) return 1.0;
        work_.spend(looks_per_test);
        if (!meets(corners)) return 1.0;
        for (const uint32_t face : faces_) is_pierced[face] = true;
        is_pierced[other] = true;
        return work_.spend(faces_.size()) ? 1.0 : 0.0;
    }

    std::vector<bool> is_pierced; // by face

private:
    bool meets(const std::array<uint32_t, 3>& corners) const
    {
        const auto& v = surface_.vertices;
        const glm::dvec3 &p = v[from_], &q = v[to_], &a = v[corners[0]], &b = v[corners[1]], &c = v[corners[2]];
        const int side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
        if (side_p * side_q > 0 || (side_p == 0 && side_q == 0)) return false;
        const int ab = line_orientation(p, q, a, b), bc = line_orientation(p, q, b, c),
                  ca = line_orientation(p, q, c, a);
        return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    }

    const Surface& surface_;
    BuildWork& work_;
    std::vector<bool> is_done_; // [3 * face + edge]
    std::vector<uint32_t> faces_;
    uint32_t from_ = 0, to_ = 0;
};

} // namespace

void find_piercing(Surface& surface, MeshReport& report, BuildWork& work)
{
    if (!work.begin("which of its triangles cut each other")) return;
    EdgeAgainstFaces edges(surface, work);
    for (uint32_t f = 0; f < surface.faces.size() && !work.over(); ++f)
        for (uint32_t i = 0; i < 3; ++i) edges.run(f, i);
    report.pierced = static_cast<std::size_t>(std::count(edges.is_pierced.begin(), edges.is_pierced.end(), true));
    surface.cuts_itself = report.pierced > 0;
}

} // namespace haptel::runtime
