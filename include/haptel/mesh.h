// Triangle meshes, and shapes that are made of them. Lengths in metres.
#pragma once

#include <haptel/export.h>

#include <array>
#include <cstdint>
#include <vector>

namespace haptel {

// In metres where it is a place, in newtons where it is a force: names of such values end in their unit.
struct Vec3 {
    double x = 0, y = 0, z = 0; // components
};

// What you have: it is repaired where it is touched. Holes, stray triangles and sheets that pierce each other may be
// felt, and no hand falls through what is closed.
struct Mesh {
    std::vector<Vec3> positions_m = {}; // of the corners
    // Indices into positions_m, counter-clockwise seen from outside.
    std::vector<std::array<uint32_t, 3>> triangles = {};
    std::vector<std::array<double, 2>> uv = {}; // texture coordinates: empty, or one per position
    // Empty, or one per triangle: those of different groups meet in creases, those of group 0 with all. Where it is
    // empty, edges sharper than 40 degrees are creases.
    std::vector<uint32_t> smoothing_groups = {};
};

// Centred on the origin. Sizes are finite and > 0, or the shape is empty, which a scene refuses.
HAPTEL_API Mesh plane(double side_m);           // a square at z = 0 that faces +z
HAPTEL_API Mesh box(const Vec3& sides_m);       // with edges along the axes
HAPTEL_API Mesh sphere(double diameter_m);      // by longitude and latitude, with uv
HAPTEL_API Mesh icosphere(double diameter_m);   // of even triangles, without uv
HAPTEL_API Mesh torus(double outer_diameter_m); // round the z axis, its tube 0.4 of the ring, with uv

} // namespace haptel
