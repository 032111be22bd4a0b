// Which triangles' boxes does a segment or a ball meet? A tree of boxes, eight to a node.
//
// Boxes are in single precision, widened by more than rounding a query to it can be off; what is handed back are
// candidates, and whoever asks decides in exact arithmetic (collision.h). Rounding can therefore only add candidates,
// never lose one. The tree depends on the triangles alone, not on the processor or how many threads made it.
//
// All coordinates are lattice units. Queries allocate nothing, and any number of threads may ask at once.
#pragma once

#include "runtime/surface/surface.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace haptel::runtime {

class BoxTree {
public:
    static constexpr uint32_t width = 8, is_face = 1u << 31;
    // A node is this many nodes below the root at most: room for what waits while a query goes down.
    static constexpr uint32_t depth_max = 40;

    struct alignas(32) Node {
        float low[3][width], high[3][width]; // by axis; of an empty place the low is above the high
        uint32_t child[width];               // a node behind this one, or a face with `is_face`
    };

    // Faces that a query names one after another are far apart in memory: whoever reads them asks for each so many
    // ahead.
    static constexpr std::size_t lookahead = 8;

    // A cylinder around all that is behind a node (discs.h). Lattice units; the axis has a length of 1 within rounding.
    struct Disc {
        static constexpr std::size_t faces_most = 512; // behind one: beyond that it would not be flat

        glm::vec3 centre{0}, axis{0, 0, 1};
        float radius = std::numeric_limits<float>::infinity(), half_height = radius;
    };

    // Of faces that live as long as this and do not change. `threads`: for its discs, 0: one for each processor.
    BoxTree(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces, std::vector<Node> nodes,
            unsigned threads);
    BoxTree(const BoxTree&) = delete;
    BoxTree& operator=(const BoxTree&) = delete;

    const std::vector<Node>& nodes() const { return nodes_; }
    const Disc& disc(uint32_t node) const noexcept { return discs_[node]; }
    // A bit for each child of a node whose box comes within `radius` of the centre.
    uint32_t children_near(uint32_t node, const glm::dvec3& centre, double radius) const noexcept;

    // Told of each candidate. Returns how much is still of interest. Of a segment a fraction: 1 to see all the others,
    // the fraction of the best hit so far to see only what may come before it. Of a ball how far from its centre: the
    // distance of the nearest thing so far to see only what may be nearer, 0: enough is known. By std::ref: what is
    // called is not copied, which might allocate.
    using Visit = std::function<double(uint32_t face)>;
    void segment(const glm::dvec3& from, const glm::dvec3& to, const Visit& visit) const noexcept;

    // Every face whose box comes within `radius` of the centre, roughly the near ones first.
    void ball(const glm::dvec3& centre, double radius, const Visit& visit) const noexcept;
    // The same faces, and some a little farther away, as a list that has room for so many; false if there are more.
    bool ball(const glm::dvec3& centre, double radius, std::size_t most, std::vector<uint32_t>& faces) const noexcept;

    // Calls visit(face) for each face whose box a region may meet, and all boxes around it, until that says false.
    // Returns whether all were visited. region.met(node): a bit for each of the node's boxes that it may meet.
    template <class Region, class Visit>
    bool for_each(const Region& region, Visit&& visit) const
    {
        uint32_t waiting[depth_max * (width - 1) + width];
        std::size_t count = 0;
        waiting[count++] = 0;
        while (count > 0) {
            const Node& node = nodes_[waiting[--count]];
            for (uint32_t met = region.met(node); met != 0;) {
                const auto k = static_cast<uint32_t>(std::bit_width(met)) - 1;
                met ^= 1u << k;
                if (!(node.child[k] & is_face))
                    waiting[count++] = node.child[k];
                else if (!visit(node.child[k] & ~is_face))
                    return false;
            }
        }
        return true;
    }

    // The object lies within [-1, 1] there, and the workspace within [-4, 4].
    static constexpr double scale = 1.0 / Lattice::extent;

    // Of boxes. With a workspace of 4 a query's start moves by up to 2^-23 as it is rounded, its end by 2^-22 more. A
    // plane is up to 5 away from the start, and where a segment meets it is off by three roundings: another 2^-20.
    static constexpr float widening = 0x1p-19f;

private:
    template <class Query>
    void ask(Query& query) const noexcept;

    const std::vector<glm::dvec3>& vertices_;
    const std::vector<Face>& faces_;
    std::vector<Node> nodes_; // the root is the first
    std::vector<Disc> discs_; // of each
};

} // namespace haptel::runtime
