#include "runtime/surface/surface_distance.h"

#include "runtime/geometry/nearest_point.h"
#include "runtime/surface/box_tree.h"

namespace haptel::runtime {

namespace {

// Looked for this much farther than asked: what is found beyond the reach spares the queries on the way there.
constexpr double foresight = 2;

// The way since it was last looked is rounded up by this, so that rounding spares no query that was needed.
constexpr double up = 1 + 1e-9;

// Lattice units.
class Nearest final : public FaceVisitor {
public:
    Nearest(const Surface& surface, const glm::dvec3& from, double radius)
        : distance(radius), surface_(surface), from_(from)
    {
    }

    double visit(uint32_t face_seen) noexcept override
    {
        const auto [a, b, c] = surface_.corners(face_seen);
        const glm::dvec3 there = nearest_point(a, b, c, from_).at;
        const double away = glm::distance(from_, there);
        if (away < distance || (away == distance && face_seen < face)) {
            distance = away;
            point = there;
            face = face_seen;
        }
        return ++seen < SurfaceDistance::triangles_max ? distance : 0;
    }

    double distance;
    glm::dvec3 point{0};
    uint32_t face = ~uint32_t{0};
    uint32_t seen = 0;

private:
    const Surface& surface_;
    const glm::dvec3& from_;
};

} // namespace

std::optional<NearestOnSurface> SurfaceDistance::within(const glm::dvec3& from_m, double reach_m) noexcept
{
    if (glm::distance(from_m, free_at_m_) * up < free_m_ - reach_m) return std::nullopt;
    const glm::dvec3 from = surface_->lattice.units(from_m);
    Nearest nearest(*surface_, from, foresight * reach_m / surface_->lattice.unit_m);
    if (face_ != none) nearest.visit(face_);
    surface_->tree->ball(from, nearest.distance, nearest);
    ++queries_;
    triangles_ += nearest.seen;

    face_ = nearest.face;
    free_at_m_ = from_m;
    const double distance_m = nearest.distance * surface_->lattice.unit_m;
    free_m_ = nearest.seen < triangles_max ? distance_m : -1;
    if (distance_m > reach_m || face_ == none) return std::nullopt;
    return NearestOnSurface{surface_->lattice.metres(nearest.point), distance_m};
}

} // namespace haptel::runtime
