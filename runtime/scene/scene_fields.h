// The numbers of a scene: what each is called, what it measures and which values it may have. Each stands here once,
// for scenes that are read from a file and for those that a program builds (validation.h).
//
// A visitor is called as visit(key, value, quantity, range), with a number or three of them, each within the range.
#pragma once

#include "runtime/hand/hand.h"
#include "runtime/hand/probe.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/object_effects.h"
#include "runtime/scene/region.h"
#include "runtime/scene/scene.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace haptel::runtime {

enum class Quantity : uint8_t {
    number,
    length,
    speed,
    angle_deg,
    turning_deg_per_s,
    force,
    stiffness,
    damping,
    frequency,
    time
};

// Closed at both ends, or open at the lower one.
struct Range {
    double minimum, maximum;
    bool above_minimum = false;

    bool holds(double value) const // never NaN
    {
        return (above_minimum ? value > minimum : value >= minimum) && value <= maximum;
    }
};

// "`rate_hz` must be from 10 to 100000, found ", and what was found.
std::string out_of_range(std::string_view key, const Range& range, std::string_view found);

// As people write it: 0.1, 500, 1e+20.
std::string shortest(double value);

void servo_fields(auto& servo, auto&& visit)
{
    visit("rate_hz", servo.rate_hz, Quantity::frequency, Range{10, 100'000});
    visit("lateral_depth_m", servo.force.lateral_depth_m, Quantity::length, Range{0, 1, true});
    visit("force_limit_n", servo.force_limit_n, Quantity::force, Range{0, 100, true});
    visit("v_max_m_per_s", servo.v_max_m_per_s, Quantity::speed, Range{0, 10, true});
    visit("force_rise_s", servo.force_rise_s, Quantity::time, Range{0, 10});
    visit("wait_for_small_force_n", servo.wait_for_small_force_n, Quantity::force, Range{0, 100});
}

void probe_fields(auto& probe, auto&& visit)
{
    visit("radius_m", probe.radius_m, Quantity::length, Range{0, 10});
    if (probe.grip_m) visit("grip_m", *probe.grip_m, Quantity::length, Range{0, 10});
    if (probe.has_tail()) visit("length_m", probe.length_m, Quantity::length, Range{0, 10, true});
}

void workspace_fields(auto& workspace, auto&& visit)
{
    visit("scale", workspace.scale, Quantity::number, Range{1e-3, 1e3});
}

// Rotations are read from angles, and checked for being any (placement.h).
void placement_fields(auto& placement, auto&& visit)
{
    visit("position_m", placement.position_m, Quantity::length, Range{-1000, 1000});
}

void material_fields(auto& material, auto&& visit)
{
    visit("stiffness_n_per_m", material.stiffness_n_per_m, Quantity::stiffness, Range{0, 1e6, true});
    visit("damping_n_s_per_m", material.damping_n_s_per_m, Quantity::damping, Range{0, 1e4});
    visit("static_friction", material.static_friction, Quantity::number, Range{0, 10});
    visit("dynamic_friction", material.dynamic_friction, Quantity::number, Range{0, 10});
}

void swing_fields(auto& figures, auto&& visit)
{
    visit("swing_m", figures.swing_m, Quantity::length, Range{-1000, 1000});
    visit("swing_hz", figures.swing_hz, Quantity::frequency, Range{0, 1000, true});
}

void magnet_fields(auto& magnet, auto&& visit)
{
    visit("force_n", magnet.force_n, Quantity::force, Range{0, 100});
    visit("reach_m", magnet.reach_m, Quantity::length, Range{0, 1000, true});
}

void viscosity_fields(auto& effects, auto&& visit)
{
    visit("damping_n_s_per_m", effects.damping_n_s_per_m, Quantity::damping, Range{0, 1000});
    visit("reach_m", effects.damping_reach_m, Quantity::length, Range{0, 1000, true});
}

// The direction is made a unit vector of what a file says.
void vibration_fields(auto& vibration, auto&& visit)
{
    visit("force_n", vibration.force_n, Quantity::force, Range{0, 100});
    visit("frequency_hz", vibration.frequency_hz, Quantity::frequency, Range{0, 100'000, true});
    visit("direction", vibration.direction, Quantity::number, Range{-1e6, 1e6});
}

void vibration_reach_field(auto& reach_m, auto&& visit)
{
    visit("reach_m", reach_m, Quantity::length, Range{0, 1000});
}

void region_fields(auto& region, auto&& visit)
{
    visit("damping_n_s_per_m", region.damping_n_s_per_m, Quantity::damping, Range{0, 1000});
    if (region.shape != RegionShape::space) visit("edge_m", region.edge_m, Quantity::length, Range{0, 1000, true});
}

// The radius of a ball, or a side of a box.
inline constexpr Range region_size_m{0, 1000, true};

} // namespace haptel::runtime
