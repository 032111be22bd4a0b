// The one solver of contact: of all places that satisfy the rows' constraints, the one nearest to a target, by the dual
// active set method (Goldfarb and Idnani 1983). The place is that of a point, or of both ends of a shaft. The Lagrange
// multiplier of a row, its push, is the force of that contact over the stiffness. Unlike the corner of three planes,
// the nearest place moves no farther than the target does, however nearly parallel the planes are: nothing can be
// wedged between them. Any one unit of length; the same bits for the same rows.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptel::runtime {

struct Shaft {
    glm::dvec3 tip{0}, tail{0};

    glm::dvec3 at(double share) const { return tip + share * (tail - tip); }
    Shaft rounded() const { return {glm::round(tip), glm::round(tail)}; }
    // A push of its point at `share`, as its ends feel it.
    static Shaft pushed_at(double share, const glm::dvec3& push) { return {(1 - share) * push, share * push}; }

    Shaft& operator+=(const Shaft& other) { return tip += other.tip, tail += other.tail, *this; }
    Shaft& operator-=(const Shaft& other) { return tip -= other.tip, tail -= other.tail, *this; }
    bool operator==(const Shaft&) const = default;
};

inline Shaft operator+(Shaft a, const Shaft& b)
{
    return a += b;
}
inline Shaft operator-(Shaft a, const Shaft& b)
{
    return a -= b;
}
inline Shaft operator*(double factor, const Shaft& a)
{
    return {factor * a.tip, factor * a.tail};
}
inline Shaft operator/(const Shaft& a, double divisor)
{
    return {a.tip / divisor, a.tail / divisor};
}
inline double dot(const Shaft& a, const Shaft& b)
{
    return glm::dot(a.tip, b.tip) + glm::dot(a.tail, b.tail);
}
inline double length(const Shaft& a)
{
    return std::sqrt(dot(a, a));
}

// Sine of the angle below which two directions count as one: what is found by their difference would be rounding.
inline constexpr double nearly_parallel = 1e-7;

// All places x of a point with dot(normal, x) >= offset.
struct HalfSpace {
    glm::dvec3 normal; // unit
    double offset;
};

// The same of the shaft's point at `arm`, 0 at its tip and 1 at its tail.
struct ShaftRow {
    glm::dvec3 normal{0}; // unit
    double offset = 0, arm = 0;

    Shaft pushed(double by) const { return {(1 - arm) * by * normal, arm * by * normal}; }
};

// Which ends may move. An end that does not give stays where it is, whatever pushes it.
struct EndsGive {
    bool tip = true, tail = true;
};

// As many rows are active as a place has coordinates, at most.
template <class Place>
struct Projection {
    static constexpr std::size_t active_max = sizeof(Place) / sizeof(double);

    Place at;
    // at - target = sum of push[i] * normal of row active[i]; of a shaft by 1 - arm at the tip and arm at the tail.
    // Each push >= 0.
    std::size_t count = 0;
    std::array<uint32_t, active_max> active{};
    std::array<double, active_max> push{};
};

// A row counts as satisfied within `tolerance`. Rows that contradict the others within rounding are left out.
Projection<Shaft> project(std::span<const ShaftRow> rows, const Shaft& target, double tolerance,
                          EndsGive gives = {}) noexcept;

// `inside` satisfies all rows. It guards against rounding: if the solution does not, the result is the last place that
// does on the straight way from `inside` to it.
Projection<glm::dvec3> project(std::span<const HalfSpace> rows, const glm::dvec3& target, const glm::dvec3& inside,
                               double tolerance) noexcept;

// Rows that become better known when they are asked for: `renew` lays a row anew, or has others take its place, which
// are told behind the rest, and says whether it did. What is active in the end has been asked for.
class RenewedRows {
public:
    virtual std::span<const HalfSpace> rows() const noexcept = 0;
    virtual bool renew(uint32_t row) noexcept = 0;

protected:
    ~RenewedRows() = default;
};
Projection<glm::dvec3> project(RenewedRows& rows, const glm::dvec3& target, const glm::dvec3& inside,
                               double tolerance) noexcept;

// The share, 0 .. 1, of the straight way from `from`, which satisfies all rows, that does so within `tolerance`.
double open_share(std::span<const HalfSpace> rows, const glm::dvec3& from, const glm::dvec3& way,
                  double tolerance) noexcept;

// The displacement of an end per displacement of the target's, as a matrix, while the rows stay active: the identity
// for a free end.
enum class ShaftEnd : uint8_t { tip, tail };
glm::dmat3 compliance(ShaftEnd end, std::span<const ShaftRow> rows, const Projection<Shaft>& held,
                      EndsGive gives = {}) noexcept;

} // namespace haptel::runtime
