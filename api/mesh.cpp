#include "api/conversions.h"
#include "runtime/surface/shapes.h"

#include <cmath>

namespace haptel {

namespace {

bool is_size(double size_m)
{
    return size_m > 0 && std::isfinite(size_m);
}

Mesh from_runtime(const runtime::Mesh& mesh)
{
    Mesh made;
    for (const glm::dvec3& p : mesh.positions_m) made.positions_m.push_back(from_glm(p));
    made.triangles = mesh.triangles;
    for (const glm::dvec2& uv : mesh.uv) made.uv.push_back({uv.x, uv.y});
    made.smoothing_groups = mesh.smoothing_groups;
    return made;
}

Mesh scaled(runtime::Mesh mesh, double size_m)
{
    if (!is_size(size_m)) return {};
    runtime::scale_to_size(mesh, size_m);
    return from_runtime(mesh);
}

} // namespace

runtime::Mesh to_runtime(Mesh mesh)
{
    runtime::Mesh made;
    made.positions_m.reserve(mesh.positions_m.size());
    for (const Vec3& p : mesh.positions_m) made.positions_m.push_back(to_glm(p));
    made.triangles = std::move(mesh.triangles);
    for (const auto& uv : mesh.uv) made.uv.emplace_back(uv[0], uv[1]);
    made.smoothing_groups = std::move(mesh.smoothing_groups);
    return made;
}

Mesh plane(double side_m)
{
    return scaled(runtime::make_plane(), side_m);
}

Mesh box(const Vec3& sides_m)
{
    if (!is_size(sides_m.x) || !is_size(sides_m.y) || !is_size(sides_m.z)) return {};
    return from_runtime(runtime::make_box(to_glm(sides_m)));
}

Mesh sphere(double diameter_m)
{
    return scaled(runtime::make_sphere(), diameter_m);
}

Mesh icosphere(double diameter_m)
{
    return scaled(runtime::make_icosphere(), diameter_m);
}

Mesh torus(double outer_diameter_m)
{
    return scaled(runtime::make_torus(), outer_diameter_m);
}

} // namespace haptel
