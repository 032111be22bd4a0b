#include "runtime/geometry/predicates.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/edges.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

namespace haptel::runtime {

namespace {

constexpr std::size_t looks_per_test = 8;

// Two faces that are not neighbours cut or touch each other exactly if an edge of one meets the other. Ties count
// as touching. A face in the plane of the edge cannot stop a path along it.
class EdgeAgainstFaces final : public FaceVisitor {
public:
    EdgeAgainstFaces(const Surface& surface, BuildWork& work, std::vector<std::atomic<bool>>& is_pierced)
        : surface_(surface), work_(work), is_pierced_(is_pierced)
    {
    }

    // With all the faces that have it.
    void run(std::span<const uint32_t> edge)
    {
        if (!work_.spend()) return;
        edge_ = edge;
        const HalfEdge first{edge[0]};
        from_ = surface_.faces[first.face()].vertex[first.edge()];
        to_ = surface_.faces[first.face()].vertex[next(first.edge())];
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
        for (const uint32_t code : edge_) is_pierced_[HalfEdge{code}.face()].store(true, std::memory_order_relaxed);
        is_pierced_[other].store(true, std::memory_order_relaxed);
        return work_.spend(edge_.size()) ? 1.0 : 0.0;
    }

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
    BuildWork::Share work_;
    std::vector<std::atomic<bool>>& is_pierced_; // by face
    std::span<const uint32_t> edge_;
    uint32_t from_ = 0, to_ = 0;
};

} // namespace

void find_piercing(Surface& surface, const Edges& edges, MeshReport& report, BuildWork& work)
{
    if (!work.begin("which of its triangles cut each other")) return;
    std::vector<std::atomic<bool>> is_pierced(surface.faces.size());
    in_pieces(edges.vertices(), work.threads(), [&](std::size_t begin, std::size_t end, std::size_t) {
        EdgeAgainstFaces against(surface, work, is_pierced);
        for (std::size_t low = begin; low < end && !work.over(); ++low)
            edges.visit(low, [&](std::span<const uint32_t> edge) { against.run(edge); });
    });
    report.pierced = static_cast<std::size_t>(std::count(is_pierced.begin(), is_pierced.end(), true));
    surface.cuts_itself = report.pierced > 0;
}

} // namespace haptel::runtime
