#include "runtime/geometry/predicates.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/edges.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

namespace haptel::runtime {

namespace {

// One face at an edge. The edge's direction is from its smaller vertex to its larger one.
struct Wing {
    uint32_t low, high;  // vertices of the edge
    uint32_t face, edge; // the face's own name for it
    uint32_t tip;        // the face's third vertex

    // The side that is seen when turning counter-clockwise around the edge's direction, away from the face.
    uint32_t upper_side(const Surface& surface) const { return surface.faces[face].vertex[edge] == low ? 0 : 1; }
};

Wing wing_of(const Surface& surface, HalfEdge at)
{
    const auto& corners = surface.faces[at.face()].vertex;
    const auto [low, high] = std::minmax({corners[at.edge()], corners[next(at.edge())]});
    return {low, high, at.face(), at.edge(), corners[previous(at.edge())]};
}

// Counter-clockwise order around the edge, starting at the face with tip `reference`.
struct RadialOrder {
    const std::vector<glm::dvec3>& v;
    const Wing& reference;

    // 0: level with the reference; 1: less than half a turn ahead; 2: opposite; 3: more than half a turn.
    int quarter(const Wing& wing) const
    {
        const glm::dvec3 &a = v[reference.low], &b = v[reference.high], &r = v[reference.tip];
        if (const int side = orientation(a, b, r, v[wing.tip])) return side > 0 ? 1 : 3;
        return points_forward(wing) == points_forward(reference) ? 0 : 2; // in one plane their normals are parallel
    }
    bool points_forward(const Wing& w) const { return exact_normal(v[w.low], v[w.high], v[w.tip]).points_forward(); }

    bool operator()(const Wing& i, const Wing& j) const
    {
        const int qi = quarter(i), qj = quarter(j);
        if (qi != qj) return qi < qj;
        if (const int turn = orientation(v[i.low], v[i.high], v[i.tip], v[j.tip])) return turn > 0;
        // They lie on each other: in the order in which a path meets them, see earlier().
        return points_forward(i) ? i.face > j.face : i.face < j.face;
    }
};

void join(Surface& surface, const Wing& from, const Wing& to)
{
    const SideEdge above(from.face, from.edge, from.upper_side(surface));
    const SideEdge below(to.face, to.edge, 1 - to.upper_side(surface));
    surface.faces[from.face].link[from.edge][above.side()] = below;
    surface.faces[to.face].link[to.edge][below.side()] = above;
}

} // namespace

void link_faces(Surface& surface, const Edges& edges, MeshReport& report, unsigned threads)
{
    each_in_parallel(surface.faces.size(), threads, [&](uint32_t f) {
        const auto [a, b, c] = surface.corners(f);
        surface.faces[f].normal = exact_normal(a, b, c).unit();
    });
    std::atomic<std::size_t> border_edges = 0;
    in_pieces(edges.vertices(), threads, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<Wing> wings;
        for (std::size_t low = begin; low < end; ++low)
            edges.visit(low, [&](std::span<const uint32_t> codes) {
                wings.clear();
                for (const uint32_t code : codes) wings.push_back(wing_of(surface, HalfEdge{code}));
                const std::size_t count = wings.size();
                border_edges += count == 1;
                if (count > 2) {
                    const Wing reference = wings[0];
                    std::sort(wings.begin(), wings.end(), RadialOrder{surface.vertices, reference});
                }
                for (std::size_t k = 0; k < count; ++k) join(surface, wings[k], wings[k + 1 < count ? k + 1 : 0]);
            });
    });
    report.border_edges = border_edges;
}

} // namespace haptel::runtime
