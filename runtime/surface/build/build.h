// The steps that make a Surface, in order. Those that get a BuildWork end when it is over, in any state. Internal to
// the runtime; build_surface() calls them.
#pragma once

#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build_work.h"
#include "runtime/surface/surface.h"

#include <cstddef>
#include <vector>

namespace haptel::runtime {

// Lattice, vertices and faces without normal or links: what is left after repair. False: no triangle left.
bool repair(const Mesh& mesh, Surface& surface, MeshReport& report);

// Of the faces all but those without area, and all but the first of those with the same corners, whatever their
// winding, with what belongs to them.
size_t drop_flat_faces(Surface& surface);
size_t drop_repeated_faces(Surface& surface);

// Joins borders that lie on each other without sharing vertices.
void close_cracks(Surface& surface, MeshReport& report, BuildWork& work);

// Face normals, and links around each edge, by exact radial order.
void link_faces(Surface& surface, MeshReport& report);

// Fans with their angle-weighted normals, and which of them meet in a vertex.
void make_fans(Surface& surface, BuildWork& work);

// The nodes of a BoxTree of the faces, the same ones on any number of threads.
std::vector<BoxTree::Node> box_tree_of(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces,
                                       unsigned threads);

// Normals of force shading, parted where faces meet at more than crease_deg or are of different smoothing groups.
void make_shading_normals(Surface& surface, double crease_deg);

// Whether faces cut or touch each other without sharing a corner there, and how many. Needs the tree.
void find_piercing(Surface& surface, MeshReport& report, BuildWork& work);

} // namespace haptel::runtime
