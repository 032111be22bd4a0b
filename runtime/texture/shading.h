// The surface as it should feel between its vertices: interpolated normal and texture coordinates, with their
// derivatives along the facet, which a texture that reads them needs for its gradient.
#pragma once

#include "lang/abi/texture_binding.h"
#include "runtime/surface/surface.h"

namespace haptel::runtime {

// Force shading, equation (1) of the paper: vertex normals weighted by the areas of the opposite sub-triangles, which
// are the barycentric coordinates, normalised (equation (2) needs a unit normal). The vertex normals are averages of
// the facet normals around, up to the next creases. Unit, toward `side`; the facet's normal where they cancel.
glm::dvec3 shading_normal(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric) noexcept;

struct Shading {
    glm::dvec3 normal{0, 0, 1};
    glm::dmat3 normal_dp{0}; // 1/m: column j is d normal / d p_j, along the facet; 0 across it
    glm::dvec2 uv{0};
    glm::dmat3x2 uv_dp{0}; // 1/m, likewise; 0 without texture coordinates
};

// What of it beside the normal; what is not asked for stays 0.
struct Shaded {
    bool normal_dp = true, uv = true;
};

// `normal` equals shading_normal bit for bit.
Shading shade(const Surface& surface, uint32_t face, uint32_t side, const glm::dvec3& barycentric,
              Shaded what = {}) noexcept;

// What the mesh's coordinates are bound by, over all faces; all 0 without any.
UvFigures uv_figures(const Surface& surface);

} // namespace haptel::runtime
