// Orientation and crossing, decided exactly.
//
// All points are lattice points (lattice.h): vertices on the coarse lattice, probes (p, q) on the fine one, so that
// every determinant fits in 128 bits. A rounded evaluation with a proven error bound goes first and settles nearly all
// cases.
//
// Ties: a probe that lies exactly in a plane or passes exactly through an edge is decided as if every probe point were
// moved by (e, e^2, e^3) with e > 0 infinitely small. It is one move for all, so the decisions fit together: a path
// that passes through a vertex of a closed surface crosses exactly one of its faces, and in the same order everywhere.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace haptel::runtime {

__extension__ typedef __int128 Int128;

// Sign of (b-a) x (c-a) . (p-a): 1 if p is in front of the triangle, -1 behind, 0 in its plane. p may be a probe.
int orientation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) noexcept;

// The same with ties decided; 0 only if a, b, c are collinear.
int side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) noexcept;

// On which side the line from p to q passes the line from e0 to e1: sign of (q-p) . (e1-e0) x (e0-p), ties decided.
// 0 only for parallel lines. Swapping e0 and e1 swaps the sign.
int side_of_line(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& e0, const glm::dvec3& e1) noexcept;
// The same with ties left 0.
int line_orientation(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& e0, const glm::dvec3& e1) noexcept;

// The front normal (b-a) x (c-a), exact, in units of the squared vertex spacing.
struct ExactNormal {
    Int128 x, y, z;
    bool is_zero() const { return x == 0 && y == 0 && z == 0; }
    int first_sign() const noexcept; // of its first component that is not 0
    bool points_forward() const noexcept { return first_sign() > 0; }
    glm::dvec3 unit() const noexcept;
};
ExactNormal exact_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept;

// Where a segment crosses a triangle, as an exact fraction of the segment.
struct Crossing {
    uint32_t face = 0;
    uint32_t side = 0;                     // that faces the segment's start; 0: front
    Int128 numerator = 0, denominator = 1; // denominator > 0
    ExactNormal normal{0, 0, 0};           // signed like the denominator

    double fraction() const noexcept { return double(numerator) / double(denominator); }
};

// Whether the segment from p to q crosses the triangle; if so fills `crossing` but for its face.
bool crosses(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
             Crossing& crossing) noexcept;

// Which of two crossings of one segment comes first: a total order, exact, ties decided as above. Of faces that lie on
// each other the one with the lower number is the upper one, "up" being where the normal of their plane points_forward:
// one order for all, so that a path does not come between them.
bool earlier(const Crossing& a, const Crossing& b) noexcept;

} // namespace haptel::runtime
