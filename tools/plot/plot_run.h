// Pictures of an exploration: what was felt, where, and how long the servo took.
#pragma once

#include "runtime/hand/haptic_device.h"
#include "runtime/servo/histogram.h"
#include "runtime/servo/telemetry.h"
#include "tools/plot/plot_picture.h"

#include <functional>
#include <optional>
#include <span>
#include <string>

namespace haptel::tools::plot {

using SurfaceBelow = std::function<std::optional<runtime::SurfaceHit>(double x_m, double y_m)>;

// Force and depth over time; where many ticks share a pixel, all from the smallest to the largest is drawn.
Picture draw_force(std::span<const runtime::TickRecord> ticks, const std::string& title, double force_limit_n);

// The tip's path from above, coloured by force, over the surface in relief where `surface` finds one (may be empty).
Picture draw_path(std::span<const runtime::TickRecord> ticks, const std::string& title, const SurfaceBelow& surface);

// How long the ticks took, on logarithmic axes, with median, p99 and the longest.
Picture draw_tick_histogram(const runtime::Histogram& tick_ns, const std::string& title, double period_s);

} // namespace haptel::tools::plot
