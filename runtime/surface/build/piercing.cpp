#include "runtime/geometry/predicates.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/edges.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <span>
#include <vector>

namespace haptel::runtime {

namespace {

constexpr std::size_t looks_per_test = 8;

// Two faces that are not neighbours cut or touch each other exactly if an edge of one meets the other. Ties count
// as touching. A face in the plane of the edge cannot stop a path along it.
bool meets(const glm::dvec3& p, const glm::dvec3& q, const std::array<glm::dvec3, 3>& corners)
{
    const auto& [a, b, c] = corners;
    const int side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
    if (side_p * side_q > 0 || (side_p == 0 && side_q == 0)) return false;
    const int ab = line_orientation(p, q, a, b), bc = line_orientation(p, q, b, c), ca = line_orientation(p, q, c, a);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

// Of an edge, with all the faces that have it.
void pierce(const Surface& surface, std::span<const uint32_t> edge, BuildWork::Share& work,
            std::vector<std::atomic<bool>>& is_pierced)
{
    if (!work.spend()) return;
    const HalfEdge first{edge[0]};
    const auto& ends = surface.faces[first.face()].vertex;
    const uint32_t from = ends[first.edge()], to = ends[next(first.edge())];
    const glm::dvec3 &p = surface.vertices[from], &q = surface.vertices[to];
    const auto visit = [&](uint32_t other) {
        if (!work.spend()) return 0.0;
        for (uint32_t corner : surface.faces[other].vertex)
            if (corner == from || corner == to) return 1.0;
        work.spend(looks_per_test);
        if (!meets(p, q, surface.corners(other))) return 1.0;
        for (const uint32_t code : edge) is_pierced[HalfEdge{code}.face()].store(true, std::memory_order_relaxed);
        is_pierced[other].store(true, std::memory_order_relaxed);
        return work.spend(edge.size()) ? 1.0 : 0.0;
    };
    surface.tree->segment(p, q, std::ref(visit));
}

} // namespace

void find_piercing(Surface& surface, const Edges& edges, MeshReport& report, BuildWork& work)
{
    if (!work.begin("which of its triangles cut each other")) return;
    std::vector<std::atomic<bool>> is_pierced(surface.faces.size());
    in_pieces(edges.vertices(), work.threads(), [&](std::size_t begin, std::size_t end, std::size_t) {
        BuildWork::Share share(work);
        for (std::size_t low = begin; low < end && !work.over(); ++low)
            edges.visit(low, [&](std::span<const uint32_t> edge) { pierce(surface, edge, share, is_pierced); });
    });
    report.pierced = static_cast<std::size_t>(std::count(is_pierced.begin(), is_pierced.end(), true));
    surface.cuts_itself = report.pierced > 0;
}

} // namespace haptel::runtime
