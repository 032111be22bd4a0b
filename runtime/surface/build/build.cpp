#include "runtime/surface/build/build.h"

#include "runtime/surface/box_tree.h"

namespace haptel::runtime {

SurfaceResult build_surface(const Mesh& mesh, double crease_deg, const Loading* loading)
{
    SurfaceResult result;
    auto surface = std::make_shared<Surface>();
    BuildWork work(mesh.triangles.size(), loading);
    work.begin("which of its vertices are one");
    if (!repair(mesh, *surface, result.report)) {
        const std::string warning = result.report.warning();
        result.error = "the mesh has no triangle to touch" + (warning.empty() ? "" : ": " + warning);
        return result;
    }
    const bool is_joined = !surface->origins.empty(); // each part has been built by itself before
    if (!is_joined) close_cracks(*surface, result.report, work);
    if (work.begin("which of its triangles are neighbours")) {
        link_faces(*surface, result.report);
        make_fans(*surface, work);
    }
    if (work.begin("where its triangles lie")) {
        surface->tree = std::make_unique<const BoxTree>(surface->vertices, surface->faces,
                                                        box_tree_of(surface->vertices, surface->faces, work.threads()));
        if (!is_joined) find_piercing(*surface, result.report, work);
    }
    if (work.begin("how round it is")) make_shading_normals(*surface, crease_deg);
    result.error = work.error();
    if (result.error.empty()) result.surface = std::move(surface);
    return result;
}

} // namespace haptel::runtime
