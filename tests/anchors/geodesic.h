// Closed surfaces whose true shape is known, in any number of triangles.
#pragma once

#include "runtime/surface/mesh.h"

#include <cstdint>

namespace haptel::test {

// make_geodesic() of radius 1 m: 20 parts^2 triangles.
runtime::Mesh make_unit_geodesic(uint32_t parts);

// A smooth surface around the origin: its radius over directions, 1 m with bumps of 0.02 m.
struct BumpySphere {
    static double radius_m(const glm::dvec3& direction);

    // The point of the surface nearest to one that lies up to a few centimetres off it, from the surface's equation
    // alone.
    static glm::dvec3 nearest_m(const glm::dvec3& point_m);

    static runtime::Mesh mesh(uint32_t parts);
};

} // namespace haptel::test
