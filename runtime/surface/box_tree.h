// Which triangles' boxes does a segment or a ball meet? Embree answers, as a tree of boxes and nothing else.
//
// Embree works in single precision and its own triangle test loses hits; here it never sees a triangle. It is given
// boxes, widened by more than its rounding of the query can be off, and hands back candidates; whoever asks decides in
// exact arithmetic (collision.h). Rounding can therefore only add candidates, never lose one.
//
// All coordinates are lattice units. Queries allocate nothing, and any number of threads may ask at once.
#pragma once

#include "runtime/surface/surface.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace haptel::runtime {

// Told of each candidate. Returns how much of the segment is still of interest, as a fraction of it: 1 to see all the
// others, the fraction of the best hit so far to see only what may come before it.
class SegmentVisitor {
public:
    virtual double visit(uint32_t face) noexcept = 0;

protected:
    ~SegmentVisitor() = default;
};

// Told of each candidate within a ball. Returns how far from its centre is still of interest: the distance of the
// nearest thing so far to see only what may be nearer, 0: enough is known.
class BallVisitor {
public:
    virtual double visit(uint32_t face) noexcept = 0;

protected:
    ~BallVisitor() = default;
};

class BoxTree {
public:
    // Null if Embree cannot be started or runs out of memory: `error` says why.
    static std::unique_ptr<const BoxTree> build(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces,
                                                std::string& error);
    ~BoxTree();
    BoxTree(const BoxTree&) = delete;
    BoxTree& operator=(const BoxTree&) = delete;

    void segment(const glm::dvec3& from, const glm::dvec3& to, SegmentVisitor& visitor) const noexcept;

    // Every face whose box comes within `radius` of the centre, roughly the near ones first.
    void ball(const glm::dvec3& centre, double radius, BallVisitor& visitor) const noexcept;
    // The same faces, and some a little farther away, as a list that has room for so many; false if there are more.
    bool ball(const glm::dvec3& centre, double radius, std::size_t most, std::vector<uint32_t>& faces) const noexcept;

private:
    BoxTree() = default;
    struct Handles;
    std::unique_ptr<Handles> handles_;
};

} // namespace haptel::runtime
