// Meshes that several tests touch, and an independent opinion on what is inside them.
#pragma once

#include "runtime/surface/shapes.h"
#include "runtime/surface/surface.h"

#include <memory>
#include <string>
#include <vector>

namespace haptel::test {

// A smooth sphere of radius 1 with bumps of 0.02: near-coplanar facets, shallow creases.
double bumpy_radius(const glm::dvec3& direction);
runtime::Mesh make_bumpy_sphere(uint32_t subdivisions);

// An icosphere whose vertices are pulled to random radii between 0.3 and 1: needles and deep creases.
runtime::Mesh make_star(uint32_t subdivisions);

// A prism of height 4 over a profile with steps and a groove, on whole coordinates, so that much is exactly coplanar.
runtime::Mesh make_stairs();

// Cubes of a 3 x 3 x 3 grid that touch each other in edges and corners, or in corners only.
enum class Touching { edges, corners };
runtime::Mesh make_touching_cubes(Touching touching);

// Boxes that overlap without sharing edges.
runtime::Mesh make_crossing_boxes();

// What people have and no algorithm likes, by name: piercing itself, with T-junctions, open, one-sided, wound at
// random, given twice in other triangles, slivers, or no surface at all.
struct NamedMesh {
    std::string name;
    runtime::Mesh mesh;
};
std::vector<NamedMesh> make_hard_meshes();

// The same mesh where coordinates are large: 1e4 m from the origin.
runtime::Mesh far_away(runtime::Mesh mesh);

std::shared_ptr<const runtime::Surface> surface_of(const runtime::Mesh& mesh);

// Winding number of a closed surface around a point by solid angles (van Oosterom and Strackee), and the distance to
// it.
struct Winding {
    double number = 0;
    double distance_m = 0;
};
Winding winding(const runtime::Surface& surface, const glm::dvec3& point_m);

} // namespace haptel::test
