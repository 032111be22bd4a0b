#include "runtime/surface/surface.h"

#include "runtime/geometry/finite.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/collision.h"

#include <cmath>

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

double Surface::gap_to_box_m(const glm::dvec3& from_m, const glm::dvec3& to_m) const noexcept
{
    const glm::dvec3 gap_m = glm::max(box_minimum_m - glm::max(from_m, to_m), glm::min(from_m, to_m) - box_maximum_m);
    return glm::length(glm::max(gap_m, glm::dvec3(0)));
}

std::optional<SegmentHit> Surface::first_hit(const glm::dvec3& from_m, const glm::dvec3& to_m) const noexcept
{
    if (!finite(from_m) || !finite(to_m)) return std::nullopt;

    // Only the part within the workspace has lattice points; the object lies well inside it.
    const glm::dvec3 along = to_m - from_m;
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; ++k) {
        const double reach = 0.5 * Lattice::workspace * lattice.unit_m;
        const double low = lattice.centre_m[k] - reach - from_m[k], high = lattice.centre_m[k] + reach - from_m[k];
        if (along[k] == 0) {
            if (low > 0 || high < 0) return std::nullopt;
            continue;
        }
        enter = std::max(enter, std::min(low / along[k], high / along[k]));
        leave = std::min(leave, std::max(low / along[k], high / along[k]));
    }
    if (!(enter <= leave)) return std::nullopt;
    const glm::dvec3 from = lattice.snap(from_m + enter * along), to = lattice.snap(from_m + leave * along);

    Crossing crossing;
    CollisionCount count;
    if (!first_crossing(*this, from, to, StartsOn::nothing(), crossing, count)) return std::nullopt;
    const glm::dvec3 point = crossing_point(*this, crossing, from, to);
    SegmentHit hit;
    hit.face = crossing.face;
    hit.side = crossing.side;
    hit.fraction = enter + (leave - enter) * crossing.fraction();
    hit.point_m = lattice.metres(point);
    hit.barycentric = barycentric_of(*this, crossing.face, point);
    hit.facet_normal = facet_normal(crossing.face, crossing.side);
    return hit;
}

} // namespace haptel::runtime
