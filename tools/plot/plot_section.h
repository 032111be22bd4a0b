// Height and slope of a texture along a straight line.
#pragma once

#include "tools/plot/plot_texture.h"

namespace haptel::tools::plot {

// The slope is that along the line. What is finer than a pixel is drawn from the least to the greatest.
Picture draw_section(const TextureView& view);

} // namespace haptel::tools::plot
