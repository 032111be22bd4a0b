// Collision of a segment with the object in the paper's three stages: the object's box, which is the root of the tree,
// the triangles' boxes, triangles. The last is exact, so the first crossing is never lost and never out of order.
// Lattice units.
#pragma once

#include "runtime/geometry/predicates.h"
#include "runtime/surface/surface.h"

#include <cstdint>

namespace haptel::runtime {

// Work done, added up by whoever passes it.
struct CollisionCount {
    uint64_t sweeps = 0;           // segments tested against the object
    uint64_t triangles_tested = 0; // by the last stage: triangles whose box the tree delivered
};

// Faces that a segment is allowed to start on: one face, all faces at an edge, or all faces at a vertex. A straight
// line that leaves a flat face, or the free cone around an edge or a vertex, never meets those faces again.
class StartsOn {
public:
    static StartsOn nothing() { return {}; }
    static StartsOn on_edge(uint32_t vertex0, uint32_t vertex1) { return {vertex0, vertex1}; }
    static StartsOn on_vertex(uint32_t vertex) { return {vertex, vertex}; }
    // One more face to pass over.
    void also(uint32_t face) { faces_[face_count_++] = face; }

    bool skips(uint32_t face, const Face& data) const;

private:
    static constexpr uint32_t none = ~0u;
    StartsOn(uint32_t vertex0 = none, uint32_t vertex1 = none) : vertex0_(vertex0), vertex1_(vertex1) {}

    uint32_t vertex0_, vertex1_;
    uint32_t faces_[3] = {none, none, none}; // a face has no more neighbours
    uint32_t face_count_ = 0;
};

// The first face that the segment crosses. Both ends must be lattice points.
bool first_crossing(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to, const StartsOn& start,
                    Crossing& crossing, CollisionCount& count) noexcept;

// How far it is at least from the centre to the nearest triangle: at most `radius`, beyond which nothing is looked for.
double clearance(const Surface& surface, const glm::dvec3& centre, double radius) noexcept;

// Where on the segment the crossing lies, moved into its triangle: rounding must not put it outside.
glm::dvec3 crossing_point(const Surface& surface, const Crossing& crossing, const glm::dvec3& from,
                          const glm::dvec3& to) noexcept;

// Weights of the face's corners at a point of its plane, each >= 0, sum 1.
glm::dvec3 barycentric_of(const Surface& surface, uint32_t face, const glm::dvec3& point) noexcept;

} // namespace haptel::runtime
