// A texture on a ball: what reads center, extent, n or uv shows nothing true in a plane.
#pragma once

#include "tools/plot/plot_texture.h"

namespace haptel::tools::plot {

// The ball fills the window; seen from +z. uv are longitude and latitude, 0 .. 1.
Picture draw_ball(const TextureView& view);

} // namespace haptel::tools::plot
