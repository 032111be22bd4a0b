#include "runtime/surface/build/build.h"

#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/edges.h"

#include <optional>

namespace haptel::runtime {

SurfaceResult build_surface(const Mesh& mesh, double crease_deg, const Loading* loading)
{
    SurfaceResult result;
    auto surface = std::make_shared<Surface>();
    BuildWork work(mesh.triangles.size(), loading);
    const unsigned threads = work.threads();
    work.begin("which of its vertices are one");
    const auto nothing_left = [&] {
        const std::string warning = result.report.warning();
        result.error = "the mesh has no triangle to touch" + (warning.empty() ? "" : ": " + warning);
        return result;
    };
    if (!repair(mesh, *surface, result.report, threads)) return nothing_left();
    const bool is_joined = !surface->origins.empty(); // each part has been built by itself before
    std::optional<Edges> edges;
    const auto link = [&] { link_faces(*surface, edges.emplace(*surface, threads), result.report, threads); };
    if (work.begin("which of its triangles are neighbours")) {
        link();
        if (!is_joined) close_cracks(*surface, result.report, work);
        if (surface->faces.empty()) return nothing_left(); // all of them lay in cracks
        if (result.report.cracks_closed > 0) link();
        const ByNumber corners = corners_by_vertex(*surface);
        make_fans(*surface, corners, crease_deg, work);
        gather_uv(*surface, corners);
    }
    if (work.begin("where its triangles lie")) {
        surface->tree = std::make_unique<const BoxTree>(
            surface->vertices, surface->faces, box_tree_of(surface->vertices, surface->faces, threads), threads);
        if (!is_joined) find_piercing(*surface, *edges, result.report, work);
    }
    if (work.begin("how round it is")) {
        find_normal_turn(*surface, threads);
        if (!is_joined && surface->normal_turn_max_per_m > 0) find_roundness(*surface, threads);
    }
    surface->smoothing_groups = {};
    result.error = work.error();
    if (result.error.empty()) result.surface = std::move(surface);
    return result;
}

} // namespace haptel::runtime
