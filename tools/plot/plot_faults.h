// Places where a texture is not finite: hatched, since the 0 that stands in for their height looks like a height.
#pragma once

#include "tools/plot/plot_picture.h"
#include "tools/plot/plot_texture.h"

#include <string>

namespace haptel::tools::plot {

// The colour of a pixel that has a fault in it: stripes as wide as suits the picture.
Color hatch(const Picture& picture, int column, int row);

// "  ·  faults at 3 %" for a subtitle; empty where there are none. `faults`: all that were met.
std::string faults_text(double share);
// One line to whoever looks, if there are any.
void tell_faults(const TextureView& view, double share, uint32_t faults);

} // namespace haptel::tools::plot
