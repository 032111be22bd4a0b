// The force of one contact with one object, and what else is told of it.
#pragma once

#include "runtime/contact/grain.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace haptel::runtime {

struct ObjectForce {
    glm::dvec3 force_n{0}; // world frame
    double height_m = 0;
    glm::dvec3 normal{0}; // of the base surface there, as shaded; world frame
    // What the texture leaves of the friction coefficients: its own scales, times the share of the depth below the
    // base surface that is also below the texture.
    double static_share = 0, dynamic_share = 0;
    Grain grain;                      // of the friction, object space
    glm::dvec3 spring_n{0};           // of force_n: by the spring of the surface
    double felt_n_per_m = 0;          // of that spring
    double felt_m = 0;                // where it does not push: how deep the hand is below what is felt, at most 0,
    glm::dvec3 felt_dp{0};            // and the gradient of that by the hand's place, world frame
    double surface_j = 0, held_j = 0; // in the spring of the surface, and with that of friction
    uint32_t faults = 0;
    double swing_hz = 0;                         // of a vibration that the texture asks for
    bool textured = false, band_limited = false; // a texture was evaluated, with less detail than it has
    bool unmapped = false;                       // coordinates or the turning of normals were left out

    void mix_in(const ObjectForce& other, double share, const glm::dvec3& share_dp) noexcept;
};

} // namespace haptel::runtime
