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

// The share, 0 .. 1, of the straight way from `from`, which is in all half-spaces, that stays in all of them within
// `tolerance`.
double open_share(std::span<const HalfSpace> spaces, const glm::dvec3& from, const glm::dvec3& way,
                  double tolerance) noexcept;

struct NearestInHalfSpaces {
    glm::dvec3 at{0};
    // at - target = sum of push[i] * normal of spaces[active[i]], push > 0.
    std::size_t count = 0;
    std::array<uint32_t, 3> active{};
    std::array<double, 3> push{};
};

// The point of the intersection nearest to `target`, by the dual active set method (Goldfarb and Idnani 1983): it
// starts at the target and moves to the boundary of the most violated half-space until none is violated by more than
// `tolerance`. `inside` is any point of the intersection. It guards against rounding: if the solution is not inside,
// the result is the last point inside on the straight way from `inside` to it.
NearestInHalfSpaces nearest_in(std::span<const HalfSpace> spaces, const glm::dvec3& target, const glm::dvec3& inside,
                               double tolerance) noexcept;

} // namespace haptel::runtime
