// A texture on a ball or a cylinder: what reads center, extent, n or uv shows nothing true in a plane.
#pragma once

#include "tools/plot/plot_pixels.h"
#include "tools/plot/plot_texture.h"

#include <optional>

namespace haptel::tools::plot {

// The point of a body where a picture of it shows something, `at` of its middle: x to the right, y up, 1 at the edge.
// With normal, uv and their derivatives by the point along the surface.
using Body = std::optional<haptel_point>(const glm::dvec3& center_m, double radius_m, const glm::dvec2& at);

Body on_ball;     // seen from +z, so that x is to the right and y up; uv are longitude and latitude, 0 .. 1
Body on_cylinder; // its axis along z, as that of cylinder_map(), and as high as wide; seen from -y, so that z is up. uv
                  // are longitude and height, 0 .. 1

Picture draw_ball(const TextureView& view); // the body fills the window
Picture draw_cylinder(const TextureView& view);

} // namespace haptel::tools::plot
