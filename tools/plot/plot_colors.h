// Colour maps in which equal steps look equal, also in grey: viridis and magma (van der Walt and Smith, CC0).
#pragma once

#include "tools/plot/plot_picture.h"

namespace haptel::tools::plot {

using ColorMap = Color (*)(double share); // 0 .. 1, clamped; not a number is grey

Color viridis(double share);
Color magma(double share);

} // namespace haptel::tools::plot
