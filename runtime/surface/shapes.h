// Built-in shapes, made as meshes so that one contact algorithm serves all. Each is centred on the origin, its largest
// side is 1 m, and carries texture coordinates where the shape has natural ones.
#pragma once

#include "runtime/surface/mesh.h"

#include <optional>
#include <string_view>

namespace haptel::runtime {

// The square [-1/2, 1/2]^2 at z = 0, facing +z, of cells x cells squares of two triangles. cells >= 1.
Mesh make_plane(uint32_t cells = 1);

// The axis-aligned box of the given sides; each face is its own quad of two triangles.
Mesh make_box(const glm::dvec3& sides_m = {1, 1, 1});

// A sphere of diameter 1 by longitude and latitude, the poles on the z axis. longitudes >= 3, latitudes >= 2.
Mesh make_sphere(uint32_t longitudes = 96, uint32_t latitudes = 48);

// A sphere of diameter 1 from an icosahedron, every triangle split in four `subdivisions` times: 20 * 4^n triangles.
// No texture coordinates: it has no natural ones.
Mesh make_icosphere(uint32_t subdivisions = 5);

// The same with every edge of the icosahedron cut into `parts` (>= 1): 20 parts^2 triangles, less even in size.
Mesh make_geodesic(uint32_t parts);

// A torus around the z axis of outer diameter 1; `tube` is the tube's radius as a share of the ring's, in (0, 1).
Mesh make_torus(double tube = 0.4, uint32_t around = 128, uint32_t tube_sides = 48);

// A shape by the name that scenes use: "plane", "box", "sphere", "icosphere", "torus". Nothing: no such shape.
std::optional<Mesh> make_shape(std::string_view name);
inline constexpr std::array<std::string_view, 5> shape_names = {"plane", "box", "sphere", "icosphere", "torus"};

// Scales about the origin so that the largest side of the bounding box of the finite positions becomes size_m (> 0).
// A mesh without extent is left alone.
void scale_to_size(Mesh& mesh, double size_m);

} // namespace haptel::runtime
