// The point of an intersection of half-spaces that is nearest to a given one: what holds a sphere that touches several
// things at once. Unlike the corner of three planes, it moves no farther than the given point does, however nearly
// parallel the planes are: nothing can be wedged between them.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptel::runtime {

// All x with dot(normal, x) >= offset.
struct HalfSpace {
    glm::dvec3 normal; // unit
    double offset;
};

// How much of the way from a point in all of them stays in all, but for `tolerance`: 0 .. 1, and which one ends it.
struct OpenShare {
    double share = 1;
    uint32_t ended_by = ~0u;
};
OpenShare open_share(std::span<const HalfSpace> spaces, const glm::dvec3& from, const glm::dvec3& way,
                     double tolerance) noexcept;

struct NearestInHalfSpaces {
    glm::dvec3 at{0};
    // at - target = sum of push[i] * normal of spaces[active[i]], push > 0.
    std::size_t count = 0;
    std::array<uint32_t, 3> active{};
    std::array<double, 3> push{};
};

// By the dual active set method (Goldfarb and Idnani 1983): from the target out of the space most violated, until none
// is by more than `tolerance`. `inside`, a point of all of them, bounds what rounding may do: the result lies on the
// way from it to the point found, as far as that is inside.
NearestInHalfSpaces nearest_in(std::span<const HalfSpace> spaces, const glm::dvec3& target, const glm::dvec3& inside,
                               double tolerance) noexcept;

} // namespace haptel::runtime
