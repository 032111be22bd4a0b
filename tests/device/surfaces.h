// Surfaces for simulated hands in tests: closed forms instead of meshes.
#pragma once

#include "device/stroke.h"

#include <glm/glm.hpp>

namespace haptel::device {

inline constexpr double period_s = 1e-3; // of a tick

inline SurfaceBelow plane_at(double z_m)
{
    return [z_m](double x, double y) { return runtime::SurfaceHit{{x, y, z_m}, {0, 0, 1}}; };
}

// Surface where `inside(x, y)`, nothing elsewhere.
template <typename Inside>
SurfaceBelow plane_where(Inside inside)
{
    return [inside](double x, double y) -> std::optional<runtime::SurfaceHit> {
        if (!inside(x, y)) return std::nullopt;
        return runtime::SurfaceHit{{x, y, 0}, {0, 0, 1}};
    };
}

// A hand that stands still over the origin of the plane z = 0, once it has come down.
inline Stroke resting(double z_m = 0)
{
    const auto stay = [](double) { return CurvePoint{}; };
    return Stroke(stay, plane_at(z_m), *plane_at(z_m)(0, 0));
}

inline runtime::DeviceRequest request_on_plane(const std::string& name, const std::string& stroke = "circles")
{
    runtime::DeviceRequest request;
    request.name = name;
    request.stroke = stroke;
    request.box_minimum_m = {-0.05, -0.03, 0};
    request.box_maximum_m = {0.05, 0.03, 0};
    request.surface_below = plane_at(0);
    return request;
}

} // namespace haptel::device
