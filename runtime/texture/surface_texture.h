// Texture stage: from a point on the surface to the height and the gradient that are felt there.
//
// Heights reach the contact shifted to the envelope h - h_max <= 0, with h_max the upper bound of the binding: touching
// the base mesh is then necessary for touching the texture, and force starts at 0. A bound that is not proven is made
// true: before a shoulder of length L the height h is felt as it is, and from there on, x = h - (h_max - L/2) beyond
// it, as h_max - L/2 + L (t - t^3 + t^4/2) with t = min(x/L, 1). So it comes to rest at h_max, its second derivative by
// h is continuous, and its gradient is grad h (1 - 3 t^2 + 2 t^3): what is felt has a potential, whatever the texture
// does where nobody looked.
#pragma once

#include "lang/abi/abi.h"
#include "lang/abi/texture_binding.h"
#include "runtime/contact/grain.h"
#include "runtime/texture/shading.h"
#include "runtime/texture/texture_slot.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace haptel::runtime {

// Bits beside those of haptel_sample::faults.
enum : uint32_t {
    fault_height_above_bound = 1u << 8, // the height exceeds the binding's facts; cut off there, gradient 0
    fault_height_bent = 1u << 9,        // the height is beyond what was found of the texture; felt bent by a shoulder
    fault_vibration_too_fast = 1u << 10 // for the servo's rate, which makes half of it at most; left out
};

// Where a texture is evaluated, object space. What the texture does not read need not be filled, but for the normal,
// which says where the surface is that a direction of friction lies in.
struct SurfacePoint {
    glm::dvec3 p_m{0};
    Shading shading;
    double time_s = 0;
    glm::dvec3 velocity_m_per_s{0}; // of the hand along the surface
    double normal_force_n = 0;      // of the bare surface
    double tool_radius_m = 0;
};

struct TextureSample {
    double height_m = 0;    // as the texture says, or bent by a shoulder
    double envelope_m = 0;  // height - h_max, <= 0
    double raised_m = 0;    // height - min(h_min, 0), >= 0: as published where that is never below 0
    glm::dvec3 gradient{0}; // dh/dp, metres per metre: what of it is along the surface counts
    double stiffness_scale = 1, static_friction_scale = 1, dynamic_friction_scale = 1, damping_scale = 1;
    double vibration_n = 0, vibration_hz = 0;
    Grain grain;         // of the friction, in the plane of the point's normal; object space
    uint32_t faults = 0; // HAPTEL_FAULT_* and the bits above
};

// One binding at one point. Never returns NaN or infinity, whatever the texture does.
TextureSample sample_texture(const TextureBinding& binding, const SurfacePoint& point) noexcept;

// What a texture gave when it was evaluated last: it gives that again where nothing that it reads has changed, under a
// probe that sticks or a hand that rests.
struct LastSample {
    uint64_t serial = 0; // of the binding; 0: none
    haptel_point point{};
    haptel_sample sample{};
};

// What the reader feels at that point: its binding, or the linear mixture of two during a fade.
TextureSample sample_texture(const TextureReader& reader, const SurfacePoint& point, LastSample& last) noexcept;

// The linear mixture of two, `share` of the second; TextureSample() is a flat surface.
TextureSample mixed(const TextureSample& from, const TextureSample& to, double share) noexcept;

// Bits of haptel_texture::reads of what is felt now: Jacobians that nobody reads need not be computed.
uint32_t texture_reads(const TextureReader& reader) noexcept;

// Part of g along the surface: g - (g . n) n for a unit normal n.
inline glm::dvec3 tangential(const glm::dvec3& g, const glm::dvec3& n)
{
    return g - glm::dot(g, n) * n;
}

} // namespace haptel::runtime
