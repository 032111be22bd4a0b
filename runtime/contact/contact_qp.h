// A small quadratic program: the shaft nearest to the hand's, by the sum of the squared ways of its two ends, of all
// shafts that no contact forbids. Its multipliers are how hard each contact pushes.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace haptel::runtime {

// The point at `share` of the shaft (0: its tip, 1: its tail) is to lie in dot(normal, x) >= offset.
struct ShaftContact {
    glm::dvec3 normal{0}; // unit
    double share = 0;
    double offset = 0;
};

inline constexpr uint32_t shaft_contacts_max = 6;

// An end that does not give stays where it is, whatever pushes.
struct EndsGive {
    bool tip = true, tail = true;
};

// The multipliers, each >= 0: the tip moves by the sum of multiplier (1 - share) normal, the tail by that of multiplier
// share normal. Contacts that contradict each other within rounding are left out.
std::array<double, shaft_contacts_max> solve_multipliers(std::span<const ShaftContact> contacts, const glm::dvec3& tip,
                                                         const glm::dvec3& tail, EndsGive gives = {}) noexcept;

// How an end moves by a pull while the active contacts stay the same: by this matrix times the pull.
enum class ShaftEnd : uint8_t { tip, tail };
glm::dmat3 compliance(ShaftEnd end, std::span<const ShaftContact> contacts, std::span<const double> multipliers,
                      EndsGive gives = {}) noexcept;

} // namespace haptel::runtime
