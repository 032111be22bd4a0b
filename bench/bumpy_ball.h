// What the benches of the servo stroke: a ball of 10 cm with small bumps, alone or many on a grid, and the way of the
// hand over it, which differs between rows only in what the ball is made of.
#pragma once

#include "runtime/scene/scene.h"

#include <cstdint>
#include <memory>

namespace haptel::bench {

// 20 * 4^subdivisions triangles; `drawn`: with coordinates of the mesh.
runtime::Mesh bumpy_ball(uint32_t subdivisions, bool drawn = false);
// 20 * parts^2 triangles.
runtime::Mesh bumpy_geodesic(uint32_t parts);

// Where the hand is in that tick, 0.1 mm further: this high above the surface, or below it.
glm::dvec3 place_on_stroke(int tick, double height_m);

// So near to each other that the hand passes between them. The first is at the origin. No rise of the force.
std::shared_ptr<runtime::Scene> balls_on_a_grid(const std::shared_ptr<const runtime::Surface>& surface,
                                                uint64_t objects, const TextureBinding& texture,
                                                const runtime::ProbeSettings& probe);

// A texture of that text for the ball.
TextureBinding bound_over_ball(const char* text, const char* name, double footprint_m = 0);

} // namespace haptel::bench
