// Segments against triangles by brute and exact arithmetic: a second opinion that shares no code with the runtime's
// predicates, its collision or its tree. All coordinates are lattice units; points may have ten binary digits after
// the point. A rounded determinant with a generous bound goes first, integers of any size decide what it cannot.
#pragma once

#include "runtime/surface/surface.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace haptel::test {

class ExactMesh {
public:
    explicit ExactMesh(const runtime::Surface& surface); // takes vertices and corners, nothing else

    // The first face that the segment crosses if both ends are really moved by (e, e^2, e^3), e = 2^-448, and the side
    // that faces its start.
    struct Hit {
        uint32_t face = 0, side = 0;
        bool operator==(const Hit&) const = default;
    };
    std::optional<Hit> first_crossing(const glm::dvec3& from, const glm::dvec3& to) const;

    // Whether the segment, ends included, touches no triangle. A triangle whose plane holds the segment counts as
    // touched if their boxes meet.
    bool open(const glm::dvec3& from, const glm::dvec3& to) const;

    // Whether the segment touches the face and otherwise only faces of the same plane.
    bool touches_only(uint32_t face, const glm::dvec3& from, const glm::dvec3& to) const;

    bool holds(const glm::dvec3& point) const; // whether it lies on a triangle

    // 1 in front of the face's plane, -1 behind, 0 in it.
    int side_of(uint32_t face, const glm::dvec3& point) const;

    std::vector<uint32_t> near(const glm::dvec3& point, double radius) const; // within `radius`, rounded

    const glm::dvec3& corner(uint32_t face, uint32_t i) const { return vertices_[corners_[face][i]]; }
    glm::dvec3 normal(uint32_t face) const;                           // unit, front, rounded
    glm::dvec3 nearest(uint32_t face, const glm::dvec3& point) const; // on the triangle, rounded
    size_t faces() const { return corners_.size(); }

private:
    struct Node {
        glm::dvec3 minimum, maximum;
        uint32_t begin, end; // of order_, in a leaf
        uint32_t second = 0; // index of the second child; the first is the next node; 0: a leaf
    };

    void build(uint32_t begin, uint32_t end);
    bool touches(uint32_t face, const glm::dvec3& from, const glm::dvec3& to) const;
    template <class Visit>
    void visit_near(const glm::dvec3& from, const glm::dvec3& to, double radius, Visit&& visit) const;

    std::vector<glm::dvec3> vertices_;
    std::vector<std::array<uint32_t, 3>> corners_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace haptel::test
