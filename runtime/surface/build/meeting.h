// How an edge of one part meets a face of another, within a tolerance: in the lowest features that do. Of parts that
// are to lie on each other coordinates are rounded, so that hardly ever two of them meet exactly.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace haptel::runtime {

// Corners meet at up to this many tolerances: so much farther than edges that what is cut anew hardly ever comes within
// the tolerance of something again.
inline constexpr double corners_reach = 32;

struct Meeting {
    enum class Of : uint8_t {
        nothing,
        corners,         // `end` of the edge and corner `index` of the face
        corner_and_edge, // `end` and edge `index` of the face, between its corners
        edge_and_corner, // the edge, between its ends, and corner `index` of the face
        corner_and_face, // `end` and the face, within its edges
        edges,           // both between their ends, in `at`
        edge_and_face    // the edge goes through the face in `at`
    };

    Of of = Of::nothing;
    uint32_t end = 0, index = 0;
    glm::dvec3 at{0};
};

// An edge and a face by their vertices; one that they share is no meeting. Same units for all.
Meeting meeting_of(const std::vector<glm::dvec3>& vertices, const std::array<uint32_t, 2>& edge,
                   const std::array<uint32_t, 3>& face, double tolerance) noexcept;

// Whether the point lies beside the line from a to b, between its ends.
bool is_beside(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, double tolerance) noexcept;

} // namespace haptel::runtime
