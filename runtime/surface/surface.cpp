#include "runtime/surface/surface.h"

#include "runtime/geometry/finite.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/collision.h"

#include <algorithm>

namespace haptel::runtime {

Surface::Surface() = default;
Surface::~Surface() = default;

std::string MeshReport::warning() const
{
    std::string text;
    const auto add = [&](size_t count, const char* what) {
        if (count == 0) return;
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    };
    add(indices_out_of_range, "with a vertex index that does not exist");
    add(not_finite, "with a coordinate that is not finite");
    add(degenerate, "without area");
    add(duplicate, "given twice");
    if (!text.empty()) text = "dropped triangles: " + text + " (of " + std::to_string(triangles_given) + ")";
    if (pierced > 0)
        text += (text.empty() ? "" : "; ") + std::to_string(pierced) +
                " triangles cut or touch others without sharing edges: contact there takes longer";
    return text;
}

std::string MeshReport::note() const
{
    if (border_edges == 0) return {};
    return "open mesh: " + std::to_string(border_edges) + " border edges, past which a hand gets behind the surface";
}

double Surface::largest_side_m() const
{
    const glm::dvec3 sides_m = box_maximum_m - box_minimum_m;
    return std::max({sides_m.x, sides_m.y, sides_m.z});
}

double Surface::gap_to_box_m(const glm::dvec3& from_m, const glm::dvec3& to_m) const noexcept
{
    const glm::dvec3 gap_m = glm::max(box_minimum_m - glm::max(from_m, to_m), glm::min(from_m, to_m) - box_maximum_m);
    return glm::length(glm::max(gap_m, glm::dvec3(0)));
}

std::optional<SegmentHit> Surface::first_hit(const glm::dvec3& from_m, const glm::dvec3& to_m) const noexcept
{
    if (!finite(from_m) || !finite(to_m)) return std::nullopt;
    glm::dvec3 from = lattice.units(from_m), to = lattice.units(to_m);
    Crossing crossing;
    CollisionCount count;
    if (!Lattice::clip_to_workspace(from, to) || !first_crossing(*this, from, to, StartsOn::nothing(), crossing, count))
        return std::nullopt;
    const glm::dvec3 point = crossing_point(*this, crossing, from, to);
    return SegmentHit{crossing.face, crossing.side, lattice.metres(point), barycentric_of(*this, crossing.face, point),
                      facet_normal(crossing.face, crossing.side)};
}

} // namespace haptel::runtime
