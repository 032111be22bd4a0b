// How far it is from a point to a surface, for what acts before anything is touched.
#pragma once

#include "runtime/surface/collision.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace haptel::runtime {

struct NearestOnSurface {
    glm::dvec3 point_m{0};
    double distance_m = 0;
};

// One servo thread owns one. The distance is that of the triangle that was nearest before, unless a nearer one is found
// in the tree: a hand that moves little looks at few. Object space, metres.
class SurfaceDistance {
public:
    explicit SurfaceDistance(std::shared_ptr<const Surface> surface) : surface_(std::move(surface)) {}

    // The nearest point within reach, or nothing. Of several that are equally near, always the same one for the same
    // sequence of questions. Looks at `triangles_max` triangles at most, near ones first: beyond that, as in the
    // centre of a fine ball, the nearest of these. Allocates nothing.
    std::optional<NearestOnSurface> within(const glm::dvec3& from_m, double reach_m, CollisionCount& count) noexcept;

    static constexpr uint32_t triangles_max = 1024;

private:
    static constexpr uint32_t none = ~uint32_t{0};

    std::shared_ptr<const Surface> surface_;
    uint32_t face_ = none; // nearest when last looked
    // Nothing is nearer than `free_m` to where `free_at_m` is; below 0: not known.
    glm::dvec3 free_at_m_{0};
    double free_m_ = -1;
};

} // namespace haptel::runtime
