#include "tools/plot/plot_faults.h"

#include "lang/abi/abi.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace haptel::tools::plot {

Color hatch(const Picture& picture, int column, int row)
{
    constexpr double stripe = 2.5; // points, along an edge
    const int width = std::max(1, static_cast<int>(std::lround(stripe * picture.pixels_per_point())));
    return (column + row) / width % 2 == 0 ? accent_2 : Color{1, 1, 1};
}

std::string faults_text(double share)
{
    return share > 0 ? fmt::format("  ·  faults at {:.2g} %", 100 * share) : "";
}

void tell_faults(const TextureView& view, double share, uint32_t faults)
{
    if (!view.say || !(share > 0)) return;
    const char* what = faults & HAPTEL_FAULT_HEIGHT_NOT_FINITE     ? "the height is not finite there and counts as 0"
                       : faults & HAPTEL_FAULT_GRADIENT_NOT_FINITE ? "the gradient is not finite there and counts as 0"
                                                                   : "a material output is not finite or negative "
                                                                     "there and counts as 1";
    view.say(fmt::format("faults at {:.2g} % of the places, hatched: {}", 100 * share, what));
}

} // namespace haptel::tools::plot
