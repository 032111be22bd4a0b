// The object database: one object's triangles as contact needs them, immutable once built and shared between threads.
//
// Building repairs what can be repaired (and says so) and adds connectivity. Connectivity is two-sided: each face has a
// front and a back, and link(face, edge, side) is the (face, edge, side) reached by turning around the edge through the
// free space on that side. Faces are sorted radially around each edge, so any soup (open, non-manifold, badly wound)
// becomes closed two-sided sheets: at a border the front is linked to the back of the same face. A proxy that walks by
// links can therefore never change the side of a sheet except around a border.
#pragma once

#include "runtime/geometry/lattice.h"
#include "runtime/surface/mesh.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::runtime {

class BoxTree;
struct Loading;

// What was found in a mesh and mended. All counts, no unit.
struct MeshReport {
    size_t triangles_given = 0;
    size_t indices_out_of_range = 0; // triangles dropped for an index beyond the positions
    size_t not_finite = 0;           // triangles dropped for a NaN or infinite coordinate
    size_t degenerate = 0;           // triangles dropped for having no area
    size_t duplicate = 0;            // triangles dropped for having the corners of another
    size_t cracks_closed = 0;        // corners of borders that now belong to the border beside them, too
    size_t border_edges = 0;         // edges of one face only: the mesh is open there
    size_t pierced = 0;              // faces cut or touched by faces that are not their neighbours

    std::string warning() const; // one line for the user; empty when nothing was dropped and nothing is pierced
    std::string note() const;    // what is no fault but good to know: that the mesh is open; or empty
};

// One side of one edge of one face, in 32 bits. Edge i runs from corner i to corner i + 1.
struct SideEdge {
    uint32_t code = 0;

    SideEdge() = default;
    SideEdge(uint32_t face, uint32_t edge, uint32_t side) : code(face << 3 | edge << 1 | side) {}
    uint32_t face() const { return code >> 3; }
    uint32_t edge() const { return code >> 1 & 3; }
    uint32_t side() const { return code & 1; } // 0: front, where the normal points; 1: back
    bool operator==(const SideEdge&) const = default;
};

struct Face {
    std::array<uint32_t, 3> vertex;
    std::array<std::array<SideEdge, 2>, 3> link; // [edge][side]
    // [corner][side]: the fan there or, with Surface::is_part, the part of one that no crease parts.
    std::array<std::array<uint32_t, 2>, 3> fan_or_part;
    glm::dvec3 normal; // unit, front
};

// The faces around a vertex that are linked with each other on one side.
struct Fan {
    glm::dvec3 normal; // of force shading: mean of the facets' normals, unit, toward that side; zero where they cancel
    SideEdge start;    // one of its corners, by the edge that starts there
    // Fans of separate sheets that meet in this vertex only and bound the same free space, in a circle; itself if
    // alone.
    uint32_t next;
};

// What borders and creases leave of a fan, which is felt with a normal of its own.
struct FanPart {
    glm::dvec3 normal; // as of a fan
    uint32_t fan;
};

// How the facets around a corner stand for a smooth surface (facet_lines.h), of a fan or a part of one: the most of
// each of its facets.
struct Roundness {
    float raised_m = 0; // of the smooth surface above a facet
    // By which lines come nearer to each other below the facet, infinite if one slants too much, and above it.
    float bent_in_per_m = 0, bent_out_per_m = 0;
};

struct SegmentHit {
    uint32_t face = 0;
    uint32_t side = 0; // that faces the start of the segment
    glm::dvec3 point_m{0};
    glm::dvec3 barycentric{1, 0, 0};
    glm::dvec3 facet_normal{0, 0, 1}; // unit, toward the start of the segment
};

// Vertices and faces are in lattice units; what has _m is in metres, object space.
struct Surface {
    Lattice lattice;
    std::vector<glm::dvec3> vertices;
    std::vector<Face> faces;
    std::vector<Fan> fans;
    std::vector<glm::dvec2> uv;                 // texture coordinates; empty without
    std::vector<std::array<uint32_t, 3>> uv_of; // per face and corner: which
    std::vector<Origin> origins;                // per face; empty if it is of one piece
    // While it is built, as in Mesh: per face and corner, and per face; or empty.
    std::vector<std::array<glm::dvec2, 3>> corner_uv;
    std::vector<uint32_t> smoothing_groups;
    bool cuts_itself = false; // faces cut or touch each other beside the edges and vertices that they share
    std::vector<FanPart> fan_parts;
    std::vector<Roundness> roundness; // of the fans, then of their parts
    double normal_turn_max_per_m = 0; // no shading normal turns faster along its face (spectral norm); 0: flat facets
    std::unique_ptr<const BoxTree> tree;
    glm::dvec3 box_minimum_m{0}, box_maximum_m{0}; // of the vertices

    // Interpolated normals shorter than this have no direction: the facet's is felt.
    static constexpr double least_normal = 1e-6;

    Surface();
    ~Surface();
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    const glm::dvec3& vertex(uint32_t face, uint32_t corner) const { return vertices[faces[face].vertex[corner]]; }
    glm::dvec3 vertex_m(uint32_t face, uint32_t corner) const { return lattice.metres(vertex(face, corner)); }
    std::array<glm::dvec3, 3> corners(uint32_t face) const
    {
        return {vertex(face, 0), vertex(face, 1), vertex(face, 2)};
    }
    glm::dvec3 facet_normal(uint32_t face, uint32_t side = 0) const
    {
        return side ? -faces[face].normal : faces[face].normal;
    }
    static constexpr uint32_t is_part = 1u << 31;
    uint32_t fan_of(uint32_t face, uint32_t corner, uint32_t side) const
    {
        const uint32_t number = faces[face].fan_or_part[corner][side];
        return number & is_part ? fan_parts[number & ~is_part].fan : number;
    }
    // Of force shading, by a face's fan_or_part.
    const glm::dvec3& shading_normal(uint32_t fan_or_part) const
    {
        return fan_or_part & is_part ? fan_parts[fan_or_part & ~is_part].normal : fans[fan_or_part].normal;
    }
    std::array<glm::dvec3, 3> shading_normals(uint32_t face, uint32_t side) const // of its corners
    {
        const auto& of = faces[face].fan_or_part;
        return {shading_normal(of[0][side]), shading_normal(of[1][side]), shading_normal(of[2][side])};
    }
    std::size_t number_of(uint32_t fan_or_part) const
    {
        return fan_or_part & is_part ? fans.size() + (fan_or_part & ~is_part) : fan_or_part;
    }
    Roundness roundness_of(uint32_t fan_or_part) const
    {
        return roundness.empty() ? Roundness() : roundness[number_of(fan_or_part)];
    }
    // One piece that does not cut itself: links lead everywhere that a point comes to.
    bool is_clean() const { return origins.empty() && !cuts_itself; }

    double largest_side_m() const; // of its box
    // From the object's box to that of the segment; 0 where they meet.
    double gap_to_box_m(const glm::dvec3& from_m, const glm::dvec3& to_m) const noexcept;

    // First crossing of the segment, by exact predicates: never lost, whatever edge or vertex it passes through.
    // Allocates nothing. Not finite ends: nothing.
    std::optional<SegmentHit> first_hit(const glm::dvec3& from_m, const glm::dvec3& to_m) const noexcept;
};

struct SurfaceResult {
    std::shared_ptr<const Surface> surface; // null: see error
    MeshReport report;
    std::string error; // why there is nothing to touch: "the mesh has no triangle left: ..."
};

// Faces that meet at more than this angle do so in a crease, which force shading keeps: 0 leaves every facet flat, 180
// rounds everything but what the mesh's smoothing groups part.
inline constexpr double default_crease_deg = 40;

// Never throws on bad geometry. A mesh of which too much lies in one place is refused; `loading` hears what takes long,
// and may end it.
SurfaceResult build_surface(const Mesh& mesh, double crease_deg = default_crease_deg, const Loading* loading = nullptr);

} // namespace haptel::runtime
