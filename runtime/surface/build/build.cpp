#include "runtime/surface/build/build.h"

#include "runtime/surface/box_tree.h"

namespace haptel::runtime {

// Links, fans, tree and walls of the faces as they are.
static void connect(Surface& surface, SurfaceResult& result, BuildWork& work)
{
    surface.fans.clear();
    surface.pierced_by.clear();
    for (Face& face : surface.faces) face.pierced_begin = face.pierced_end = 0;
    result.report.border_edges = result.report.nonmanifold_edges = result.report.pierced = 0;
    if (!work.begin("which of its triangles are neighbours")) return;
    link_faces(surface, result.report);
    make_fans(surface, work);
    if (!work.begin("where its triangles lie")) return;
    surface.tree = BoxTree::build(surface.vertices, surface.faces, result.error);
    if (surface.tree) find_piercing(surface, result.report, work);
}

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
    close_cracks(*surface, result.report, work);
    if (!surface->origins.empty() && !work.over()) {
        BuildWork joining = BuildWork::of_joining(loading); // imprinting has limits of its own, too
        imprint(*surface, result.error, joining);
        if (joining.over()) result.error = joining.error();
        if (!result.error.empty()) return result;
    }
    int rounds = 0;
    do {
        connect(*surface, result, work);
        if (work.over()) result.error = work.error();
        if (!result.error.empty()) return result;
    } while (++rounds < 3 && part_crossing_sheets(*surface, work));
    if (work.begin("how round it is")) make_shading_normals(*surface, crease_deg);
    result.error = work.error();
    if (result.error.empty()) result.surface = std::move(surface);
    return result;
}

} // namespace haptel::runtime
