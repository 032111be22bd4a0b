// What the hand holds: the kind of the probe, its size, and where it is.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace haptel::runtime {

enum class ProbeKind : uint8_t { point, sphere, stylus, gripper };

struct ProbeSettings {
    ProbeKind kind = ProbeKind::point;
    double length_m = 0.15; // of the stylus, tip to tail; of a simulated gripper, finger to finger
    double radius_m = 0;    // of the sphere, > 0
    // Of the stylus: from its tip to where the hand holds it, about which torque is told. Nothing: at the tail.
    std::optional<double> grip_m = {};

    bool operator==(const ProbeSettings&) const = default;
    // A stylus or a gripper: where its tail is counts, and there is a torque.
    bool has_tail() const { return kind == ProbeKind::stylus || kind == ProbeKind::gripper; }
    // Where the hand holds it: a gripper in the middle between its fingers.
    glm::dvec3 grip_of(const glm::dvec3& tip_m, const glm::dvec3& tail_m) const;
};

// Where the hand holds it: the centre of a sphere is its tip; a stylus has a tail, and a gripper's is its other finger.
struct ProbePose {
    glm::dvec3 tip_m{0}, tail_m{0};

    bool operator==(const ProbePose&) const = default;
};

// How far the ends are from each other's, of the pair that is farther.
inline double farther_m(const ProbePose& a, const ProbePose& b)
{
    const glm::dvec3 tip_way_m = a.tip_m - b.tip_m, tail_way_m = a.tail_m - b.tail_m;
    return std::sqrt(std::max(glm::dot(tip_way_m, tip_way_m), glm::dot(tail_way_m, tail_way_m)));
}

} // namespace haptel::runtime
