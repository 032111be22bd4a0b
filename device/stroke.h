// Where a simulated hand means to go: a curve in the xy plane of the object's box, lifted to its surface.
//
// A curve is a pure function of time. Lifting looks straight down from above the object; where there is nothing below,
// the last point found is kept, so that the hand waits at a rim instead of diving past it. A stroke starts above the
// surface, sinks onto it, and only then presses and moves.
#pragma once

#include "runtime/hand/haptic_device.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

namespace haptel::device {

// Of every stroke, seconds and metres.
inline constexpr double approach_s = 0.5;     // sinking onto the surface
inline constexpr double approach_m = 0.01;    // from this far above
inline constexpr double press_onset_s = 0.2;  // pressure and motion begin smoothly
inline constexpr double press_on_s = 1.0;     // "press": on the surface
inline constexpr double press_off_s = 0.5;    // ... and lifted
inline constexpr double press_lift_m = 0.005; // ... by so much

struct CurvePoint {
    glm::dvec2 xy_m{0};
    double lift_m = 0; // above the surface
    double press = 1;  // share of press_n, 0 .. 1
};

using Curve = std::function<CurvePoint(double time_s)>;

struct CurveRequest {
    glm::dvec2 box_minimum_m{0}, box_maximum_m{0};
    glm::dvec2 anchor_m{0}; // where the surface is, nearest to the centre of the box
    double speed_m_per_s = 0.1;
    uint64_t seed = 1;
};

// Names that make_curve knows: circles, scan, press, random.
std::span<const std::string_view> stroke_names();

// circles: round the anchor, radius 0.15 of the smaller horizontal side, counterclockwise.
// scan:    lines along x over the central 60 % of the box, 5 % of its depth apart, there and back.
// press:   at the anchor, press_on_s on the surface, press_off_s off it; speed is that of sinking and lifting.
// random:  smooth within the central 60 %; speed is the root mean square. Equal seeds give equal curves.
// All keep to the speed in the xy plane. Empty if there is no curve of that name.
Curve make_curve(std::string_view name, const CurveRequest& request);

// A place the hand means to be at, and how it means to press there.
struct StrokeTarget {
    glm::dvec3 point_m{0};
    glm::dvec3 normal{0, 0, 1}; // of the facet, outward
    double press = 0;           // share of press_n, 0 .. 1
};

using runtime::SurfaceBelow;

// The hit nearest to the centre of the box: its centre, or the nearest point of a grid of 101 x 101. Nothing if all
// miss.
std::optional<runtime::SurfaceHit> nearest_hit(const SurfaceBelow& surface, glm::dvec2 box_minimum_m,
                                               glm::dvec2 box_maximum_m);

class Stroke {
public:
    // `start` is kept until the curve finds a hit of its own.
    Stroke(Curve curve, SurfaceBelow surface, const runtime::SurfaceHit& start);

    // Times must not fall: a miss keeps the hit of the call before. Allocates nothing if the surface does not.
    StrokeTarget at(double time_s);

private:
    Curve curve_;
    SurfaceBelow surface_;
    runtime::SurfaceHit last_;
};

} // namespace haptel::device
