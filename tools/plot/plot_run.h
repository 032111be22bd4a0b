// Pictures of an exploration: what was felt, where, and how long the servo took.
#pragma once

#include "runtime/servo/histogram.h"
#include "runtime/servo/telemetry.h"
#include "tools/plot/plot_picture.h"
#include "tools/plot/plot_surface.h"

#include <span>
#include <string>

namespace haptel::tools::plot {

// Force and depth over time; where many ticks share a pixel, all from the smallest to the largest is drawn.
Picture draw_force(std::span<const runtime::TickRecord> ticks, const std::string& title, double force_limit_n);

// The tip's path from above, coloured by force, over the textured surface in relief (none if `surface` is empty).
Picture draw_path(std::span<const runtime::TickRecord> ticks, const std::string& title, const NormalBelow& surface);

// How long the ticks took, on logarithmic axes, with median, p99 and the longest.
Picture draw_tick_histogram(const runtime::Histogram& tick_ns, const std::string& title, double period_s);

} // namespace haptel::tools::plot
