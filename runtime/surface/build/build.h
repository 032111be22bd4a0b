// The steps that make a Surface, in order. Those that get a BuildWork end when it is over, in any state. Internal to
// the runtime; build_surface() calls them.
#pragma once

#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build_work.h"
#include "runtime/surface/surface.h"

#include <cstddef>
#include <vector>

namespace haptel::runtime {

class ByNumber;
class Edges;

// Lattice, vertices and faces without normal or links: what is left after repair. False: no triangle left.
bool repair(const Mesh& mesh, Surface& surface, MeshReport& report, unsigned threads = 0);

// Of the faces all but those without area, and all but the first of those with the same corners, whatever their
// winding, with what belongs to them.
size_t drop_flat_faces(Surface& surface, unsigned threads);
size_t drop_repeated_faces(Surface& surface, unsigned threads);

// Face normals, and links around each edge, by exact radial order.
void link_faces(Surface& surface, const Edges& edges, MeshReport& report, unsigned threads);

// Joins borders, if there are any, that lie on each other without sharing vertices: then they are to be linked anew.
void close_cracks(Surface& surface, MeshReport& report, BuildWork& work);

// Texture coordinates of corners, each once for a vertex.
void gather_uv(Surface& surface, const ByNumber& corners);

// Fans with their mean normals, and which of them meet in a vertex. They are parted for force shading where
// faces meet at more than crease_deg or are of different smoothing groups.
void make_fans(Surface& surface, const ByNumber& corners, double crease_deg, BuildWork& work);

// The corners of faces, 3 * face + corner, by their vertex.
ByNumber corners_by_vertex(const Surface& surface);

// The nodes of a BoxTree of the faces, the same ones on any number of threads.
std::vector<BoxTree::Node> box_tree_of(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces,
                                       unsigned threads);

// Sets how fast normals of force shading turn at most.
void find_normal_turn(Surface& surface, unsigned threads);

// Sets the roundness of all corners.
void find_roundness(Surface& surface, unsigned threads);

// Whether faces cut or touch each other without sharing a corner there, and how many. Needs the tree.
void find_piercing(Surface& surface, const Edges& edges, MeshReport& report, BuildWork& work);

} // namespace haptel::runtime
