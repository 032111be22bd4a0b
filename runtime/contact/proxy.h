// The proxy's state between ticks and the walk that moves it over the surface. Lattice units.
#pragma once

#include "runtime/contact/grain.h"
#include "runtime/surface/collision.h"
#include "runtime/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace haptel::runtime {

struct ContactCounters;

struct Proxy {
    enum class On : uint8_t { nothing, face, edge, vertex };

    On on = On::nothing;
    uint32_t face = 0, side = 0; // of the sheet it touches; a face next to the feature it is on
    uint32_t index = 0;          // the edge or corner of `face`
    bool sliding = false;        // friction: it moved since it last stuck
    double pressed = 0;          // how deep the hand is below it, as friction felt it last
    glm::dvec3 at{0};            // on nothing: the hand, a lattice point; else within rounding of the feature

    bool touches() const { return on != On::nothing; }
};

// Coulomb friction coefficients, no unit; negative or not finite counts as 0, dynamic is held at most static. Both are
// those across the grain, where there is one.
struct Friction {
    double static_coefficient = 0, dynamic_coefficient = 0;
    Grain grain = {}; // in the space of what is touched

    bool operator==(const Friction&) const = default;
};
// As it counts.
inline Friction checked(const Friction& friction) noexcept
{
    const auto coefficient = [](double mu) { return mu > 0 && std::isfinite(mu) ? mu : 0.0; };
    const double rest = coefficient(friction.static_coefficient);
    return {rest, std::min(coefficient(friction.dynamic_coefficient), rest), friction.grain};
}

// In one tick; the walk goes on in the next.
inline constexpr uint32_t walk_steps_max = 4096;

// Moves a proxy that is on the surface toward the hand (a lattice point) by steepest descent of their distance, until
// nothing nearer can be reached by sliding, friction holds, or it has left the surface and is the hand. The proxy is
// valid at every step, so the walk may end anywhere.
//
// At each feature it asks for the nearest point, to the hand, of the surface around (a face, the two faces of an edge,
// the fan of a vertex). There the sign of the hand's height says whether the hand is on the free side: if so the proxy
// leaves, if not it slides there.
void walk(const Surface& surface, Proxy& proxy, const glm::dvec3& hand, const Friction& friction,
          ContactCounters& count, uint32_t step_limit = walk_steps_max) noexcept;

// Puts a free proxy on the face that its way crosses.
void land(const Surface& surface, Proxy& proxy, const Crossing& crossing, const glm::dvec3& from,
          const glm::dvec3& to) noexcept;

} // namespace haptel::runtime
