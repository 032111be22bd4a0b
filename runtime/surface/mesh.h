// A mesh as somebody else made it: a soup of triangles, not yet trusted. surface.h repairs it into what can be touched.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace haptel::runtime {

// Of what was joined from several surfaces: which of them a triangle was part of, and which of its faces it was.
struct Origin {
    uint32_t part = 0, face = 0;
};

struct Mesh {
    std::vector<glm::dvec3> positions_m;            // object space
    std::vector<std::array<uint32_t, 3>> triangles; // indices into positions_m, counter-clockwise seen from outside
    std::vector<glm::dvec2> uv;                     // empty, or one per position; no unit
    // Empty, or one per triangle: those of different smoothing groups meet in creases, those of group 0 with all.
    std::vector<uint32_t> smoothing_groups;
    std::vector<Origin> origins; // empty, or one per triangle; then it has neither uv nor groups
};

} // namespace haptel::runtime
