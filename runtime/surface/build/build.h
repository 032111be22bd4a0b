// The steps that make a Surface, in order. Those that get a BuildWork end when it is over, in any state. Internal to
// the runtime; build_surface() calls them.
#pragma once

#include "runtime/surface/build/build_work.h"
#include "runtime/surface/surface.h"

#include <string>
#include <utility>
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

// Gives the parts of a joined surface common vertices and edges where they meet; of what lies on each other only the
// first part's is left.
void imprint(Surface& surface, std::string& error, BuildWork& work);
// Which parts meet, in rising order.
std::vector<std::pair<uint32_t, uint32_t>> meeting_parts(Surface& surface, std::string& error, BuildWork& work);

// Face normals, and links around each edge, by exact radial order.
void link_faces(Surface& surface, MeshReport& report);

// Fans with their angle-weighted normals, and which of them meet in a vertex.
void make_fans(Surface& surface, BuildWork& work);

// Normals of force shading, parted where faces meet at more than crease_deg or are of different smoothing groups.
void make_shading_normals(Surface& surface, double crease_deg);

// For each face those that cut or touch it without sharing a corner there. Needs the tree.
void find_piercing(Surface& surface, MeshReport& report, BuildWork& work);

// Gives sheets that cross each other in a vertex corners of their own. True: then what was built since repair is to be
// built anew.
bool part_crossing_sheets(Surface& surface, BuildWork& work);

} // namespace haptel::runtime
