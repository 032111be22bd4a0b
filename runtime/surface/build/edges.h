// The edges of a surface, each once with all the faces that have it.
#pragma once

#include "runtime/surface/build/by_number.h"
#include "runtime/surface/corner.h"
#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace haptel::runtime {

// Edge i of a face runs from corner i to corner next(i).
struct HalfEdge {
    uint32_t code; // 3 * face + edge
    uint32_t face() const { return code / 3; }
    uint32_t edge() const { return code % 3; }
};

class Edges {
public:
    // Of the faces as they are now.
    Edges(const Surface& surface, unsigned threads)
        : faces_(surface.faces)
        , by_low_(surface.vertices.size(), 3 * surface.faces.size(), [this](uint32_t code) { return ends(code).first; })
    {
        each_in_parallel(by_low_.numbers(), threads, [&](uint32_t low) {
            const std::span<uint32_t> codes = by_low_.of(low);
            std::ranges::sort(codes, {}, [&](uint32_t code) { return std::pair(ends(code).second, code); });
        });
    }

    // By the lower of their vertices.
    std::size_t vertices() const { return by_low_.numbers(); }
    // Calls visit(codes of half edges, by rising face) for each edge of one lower vertex.
    template <class Visit>
    void visit(std::size_t low, Visit&& visit_one) const
    {
        const std::span<const uint32_t> codes = by_low_.of(low);
        for (std::size_t begin = 0, end; begin < codes.size(); begin = end) {
            const uint32_t high = ends(codes[begin]).second;
            for (end = begin + 1; end < codes.size() && ends(codes[end]).second == high;) ++end;
            visit_one(codes.subspan(begin, end - begin));
        }
    }

private:
    std::pair<uint32_t, uint32_t> ends(uint32_t code) const
    {
        const HalfEdge at{code};
        const auto& corners = faces_[at.face()].vertex;
        return std::minmax({corners[at.edge()], corners[next(at.edge())]});
    }

    const std::vector<Face>& faces_;
    ByNumber by_low_;
};

} // namespace haptel::runtime
