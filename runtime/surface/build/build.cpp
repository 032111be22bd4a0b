#include "runtime/surface/build/build.h"

#include "runtime/surface/box_tree.h"

namespace haptel::runtime {

// Links, fans, tree and walls of the faces as they are.
static void connect(Surface& surface, SurfaceResult& result)
{
    surface.fans.clear();
    surface.pierced_by.clear();
    for (Face& face : surface.faces) face.pierced_begin = face.pierced_end = 0;
    result.report.border_edges = result.report.nonmanifold_edges = result.report.pierced = 0;
    link_faces(surface, result.report);
    make_fans(surface);
    surface.tree = BoxTree::build(surface.vertices, surface.faces, result.error);
    if (surface.tree) find_piercing(surface, result.report);
}

SurfaceResult build_surface(const Mesh& mesh, double crease_deg)
{
    SurfaceResult result;
    auto surface = std::make_shared<Surface>();
    if (!repair(mesh, *surface, result.report)) {
        const std::string warning = result.report.warning();
        result.error = "the mesh has no triangle to touch" + (warning.empty() ? "" : ": " + warning);
        return result;
    }
    close_cracks(*surface, result.report);
    if (!surface->origins.empty()) imprint(*surface, result.error);
    int rounds = 0;
    do {
        connect(*surface, result);
        if (!surface->tree) return result;
    } while (++rounds < 3 && part_crossing_sheets(*surface));
    make_shading_normals(*surface, crease_deg);
    result.surface = std::move(surface);
    return result;
}

} // namespace haptel::runtime
