#include "tools/plot/plot_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptel::tools::plot {

namespace {

using Stops = std::array<std::array<double, 3>, 9>; // at shares 0, 1/8, ..., 1; 0 .. 255

constexpr Stops viridis_stops = {{{68, 1, 84},
                                  {71, 44, 122},
                                  {59, 81, 139},
                                  {44, 113, 142},
                                  {33, 144, 141},
                                  {39, 173, 129},
                                  {92, 200, 99},
                                  {170, 220, 50},
                                  {253, 231, 37}}};
constexpr Stops magma_stops = {{{0, 0, 4},
                                {28, 16, 68},
                                {79, 18, 123},
                                {129, 37, 129},
                                {181, 54, 122},
                                {229, 80, 100},
                                {251, 135, 97},
                                {254, 194, 135},
                                {252, 253, 191}}};

Color between(const Stops& stops, double share)
{
    if (std::isnan(share)) return {0.6, 0.6, 0.6};
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double t = place - static_cast<double>(below);
    const auto mix = [&](std::size_t channel) {
        return ((1 - t) * stops[below][channel] + t * stops[below + 1][channel]) / 255;
    };
    return {mix(0), mix(1), mix(2)};
}

} // namespace

Color viridis(double share)
{
    return between(viridis_stops, share);
}
Color magma(double share)
{
    return between(magma_stops, share);
}

} // namespace haptel::tools::plot
