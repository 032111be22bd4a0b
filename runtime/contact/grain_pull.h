// What pulls a proxy over a face whose friction has a grain, and how far it slips. Lattice units.
#pragma once

#include "runtime/contact/proxy.h"

#include <algorithm>

namespace haptel::runtime {

class GrainPull {
public:
    GrainPull(const Surface& surface, const glm::dvec3& proxy, const glm::dvec3& hand, const Friction& friction,
              uint32_t face, uint32_t side) noexcept
        : normal_(surface.facet_normal(face, side))
        , ellipse_(friction.grain, normal_)
        , depth_(std::max(0.0, -glm::dot(hand - surface.vertex(face, 0), normal_)))
        , slides_by_(friction.dynamic_coefficient * depth_)
        , way_(hand - proxy - glm::dot(hand - proxy, normal_) * normal_)
    {
    }

    double depth() const noexcept { return depth_; }
    bool is_held(double coefficient) const noexcept { return ellipse_.size(way_) <= coefficient * depth_; }
    // Of the way to the foot of the hand, what dynamic friction holds and what it leaves.
    glm::dvec3 held() const noexcept
    {
        return ellipse_.size(way_) <= slides_by_ ? way_ : ellipse_.nearest(way_, slides_by_);
    }
    glm::dvec3 slip() const noexcept { return way_ - held(); }

private:
    glm::dvec3 normal_;
    FrictionEllipse ellipse_;
    double depth_, slides_by_;
    glm::dvec3 way_;
};

} // namespace haptel::runtime
