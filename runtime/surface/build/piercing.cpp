#include "runtime/geometry/predicates.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <utility>

namespace haptel::runtime {

namespace {

// Two faces that are not neighbours cut or touch each other exactly if an edge of one meets the other. Ties count
// as touching: a face listed in vain only costs time. A face in the plane of the edge cannot stop a path along it.
class EdgeAgainstFaces final : public SegmentVisitor {
public:
    EdgeAgainstFaces(const Surface& surface, std::vector<std::pair<uint32_t, uint32_t>>& pairs)
        : surface_(surface), pairs_(pairs)
    {
    }

    void run(uint32_t face, uint32_t edge)
    {
        face_ = face;
        from_ = surface_.faces[face].vertex[edge];
        to_ = surface_.faces[face].vertex[next(edge)];
        surface_.tree->segment(surface_.vertices[from_], surface_.vertices[to_], *this);
    }

    double visit(uint32_t other) noexcept override
    {
        const auto& corners = surface_.faces[other].vertex;
        for (uint32_t corner : corners)
            if (corner == from_ || corner == to_) return 1.0;
        if (meets(corners)) {
            pairs_.emplace_back(face_, other);
            pairs_.emplace_back(other, face_);
        }
        return 1.0;
    }

private:
    bool meets(const std::array<uint32_t, 3>& corners) const
    {
        const auto& v = surface_.vertices;
        const glm::dvec3 &p = v[from_], &q = v[to_], &a = v[corners[0]], &b = v[corners[1]], &c = v[corners[2]];
        const int side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
        if (side_p * side_q > 0 || (side_p == 0 && side_q == 0)) return false;
        const int ab = line_orientation(p, q, a, b), bc = line_orientation(p, q, b, c),
                  ca = line_orientation(p, q, c, a);
        return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    }

    const Surface& surface_;
    std::vector<std::pair<uint32_t, uint32_t>>& pairs_;
    uint32_t face_ = 0, from_ = 0, to_ = 0;
};

} // namespace

void find_piercing(Surface& surface, MeshReport& report)
{
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    EdgeAgainstFaces edges(surface, pairs);
    for (uint32_t f = 0; f < surface.faces.size(); ++f)
        for (uint32_t i = 0; i < 3; ++i) edges.run(f, i); // shared edges twice: both faces are to be listed

    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [face, other] : pairs) {
        Face& data = surface.faces[face];
        if (data.pierced_begin == data.pierced_end) {
            data.pierced_begin = uint32_t(surface.pierced_by.size());
            ++report.pierced;
        }
        surface.pierced_by.push_back(other);
        data.pierced_end = uint32_t(surface.pierced_by.size());
    }
}

} // namespace haptel::runtime
