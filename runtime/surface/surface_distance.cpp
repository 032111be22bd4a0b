#include "runtime/surface/surface_distance.h"

#include "runtime/geometry/nearest_point.h"
#include "runtime/surface/box_tree.h"

#include <functional>

namespace haptel::runtime {

namespace {

// Looked for this much farther than asked: what is found beyond the reach spares the queries on the way there.
constexpr double foresight = 2;

// The way since it was last looked is rounded up by this, so that rounding spares no query that was needed.
constexpr double up = 1 + 1e-9;

} // namespace

std::optional<NearestOnSurface> SurfaceDistance::within(const glm::dvec3& from_m, double reach_m,
                                                        CollisionCount& count) noexcept
{
    if (glm::distance(from_m, free_at_m_) * up < free_m_ - reach_m) return std::nullopt;
    const glm::dvec3 from = surface_->lattice.units(from_m);
    double distance = foresight * reach_m / surface_->lattice.unit_m;
    glm::dvec3 point(0);
    uint32_t face = none, seen = 0;
    const auto visit = [&](uint32_t face_seen) {
        const auto [a, b, c] = surface_->corners(face_seen);
        const glm::dvec3 there = nearest_point(a, b, c, from).at;
        const double away = glm::distance(from, there);
        if (away < distance || (away == distance && face_seen < face)) {
            distance = away;
            point = there;
            face = face_seen;
        }
        return ++seen < triangles_max ? distance : 0;
    };
    if (face_ != none) visit(face_);
    surface_->tree->ball(from, distance, std::ref(visit));
    ++count.sweeps;
    count.triangles_tested += seen;

    face_ = face;
    free_at_m_ = from_m;
    const double distance_m = distance * surface_->lattice.unit_m;
    free_m_ = seen < triangles_max ? distance_m : -1;
    if (distance_m > reach_m || face_ == none) return std::nullopt;
    return NearestOnSurface{surface_->lattice.metres(point), distance_m};
}

} // namespace haptel::runtime
