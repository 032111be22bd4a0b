// Both ends of a stylus at once.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace haptel::test {

// Places, or what pushes the ends over the stiffness, m.
struct Ends {
    glm::dvec3 tip{0}, tail{0};

    Ends operator-(const Ends& other) const { return {tip - other.tip, tail - other.tail}; }
    double square() const { return glm::dot(tip, tip) + glm::dot(tail, tail); }
    double length() const { return std::sqrt(square()); }
};

} // namespace haptel::test
