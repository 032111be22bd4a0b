// A small quadratic program for a stylus: of all shafts that satisfy the contacts' constraints, the one nearest to the
// hand's, by the sum of the squared displacements of its two ends. The Lagrange multiplier of a contact is its force
// over the stiffness. Any one unit of length.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace haptel::runtime {

// The constraint dot(normal, x) >= offset on the point x at `share` of the shaft, 0 at its tip and 1 at its tail.
struct ShaftContact {
    glm::dvec3 normal{0}; // unit
    double share = 0;
    double offset = 0;
};

inline constexpr uint32_t shaft_contacts_max = 6;

// Which ends may move. An end that does not give stays where it is, whatever pushes it.
struct EndsGive {
    bool tip = true, tail = true;
};

// The multipliers in the order of the contacts, at most shaft_contacts_max of them, each >= 0 and 0 where a contact is
// inactive. The solution moves the tip by the sum of multiplier * (1 - share) * normal, and the tail by the sum of
// multiplier * share * normal. Contacts that contradict each other within rounding are left out.
std::array<double, shaft_contacts_max> solve_multipliers(std::span<const ShaftContact> contacts, const glm::dvec3& tip,
                                                         const glm::dvec3& tail, EndsGive gives = {}) noexcept;

// The displacement of an end per displacement of the hand's, as a matrix, while the active contacts (multiplier > 0)
// stay active: the identity for a free end.
enum class ShaftEnd : uint8_t { tip, tail };
glm::dmat3 compliance(ShaftEnd end, std::span<const ShaftContact> contacts, std::span<const double> multipliers,
                      EndsGive gives = {}) noexcept;

} // namespace haptel::runtime
