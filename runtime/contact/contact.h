// Where and how a probe touches: what every kind of contact says, and friction, which all of them feel.
#pragma once

#include "runtime/contact/proxy.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace haptel::runtime {

// Of what dynamic friction holds: below this share what slid sticks again. Of what friction may hold: less is none.
inline constexpr double sticks_again = 0.5, friction_settled = 1e-6;

// Contacts that push more than so many times what presses push against each other, as the walls of a groove narrower
// than some 30 degrees do in sum, and of a shaft's each one where rounding makes the angle between them: beyond it they
// are not felt each by itself.
inline constexpr double opposed_most = 4;

// Of a probe that has two ends, which may touch what is different. One for both of them: Friction.
struct EndsFriction {
    Friction tip, tail;

    EndsFriction() = default;
    EndsFriction(const Friction& both) : tip(both), tail(both) {}
    EndsFriction(const Friction& of_tip, const Friction& of_tail) : tip(of_tip), tail(of_tail) {}
    bool operator==(const EndsFriction&) const = default;
};

// Where and how the probe touches after a tick. If !touching, proxy_m is the hand and the rest is meaningless.
struct Contact {
    bool touching = false;
    bool sliding = false;        // dynamic friction holds: the proxy slides, or slid and does not stick yet
    uint32_t face = 0, side = 0; // the face under the proxy and the side touched; 0: front
    glm::dvec3 proxy_m{0};
    glm::dvec3 hand_m{0};             // the tip as used: held, clamped, rounded to the lattice
    glm::dvec3 barycentric{1, 0, 0};  // of the proxy in its face, each >= 0, sum 1
    glm::dvec3 facet_normal{0, 0, 1}; // of the face, unit, toward the free side
    // Unit, toward the free side: the facet's on a face, between those of the faces that meet on an edge or a vertex.
    glm::dvec3 normal{0, 0, 1};
    double depth_m = 0;   // >= 0: how deep the hand is below the proxy along `normal`
    double pressed_m = 0; // what friction bears by: the depth, but in a groove that below both its walls together
    // Of the ball that touches, whose centre is so far from the place along `normal`: less than the probe's while one
    // that was put down into something has no room to grow. 0: of what touches with a point.
    double radius_m = 0;
    double along = 0;      // of a stylus or a gripper: where it touches, 0 at its tip, 1 at its tail
    bool by_shaft = false; // of a stylus: between its ends, on an edge
    // Of a stylus, together with `by_shaft`: the part of its force that no contact accounts for, in a tick in which the
    // solution for the two ends and that for the shaft did not converge. It acts at an end of the stylus, and `normal`
    // is its direction. `face` is that of the nearest known contact, whose material counts; the end need not be there.
    bool unsettled = false;
    // No shading normal is right here, but `normal`: between the walls of a narrow groove, and on a crease that is not
    // told by its rows (crease_rows.h).
    bool on_crease = false;
    // Of several facets that hold the probe as one (smooth_rows.h): how far the place goes across the groove between
    // them for the hand's way, and the direction of the groove, unit, or 0 where there is none. rolls < 0: it is one
    // facet.
    double rolls = -1;
    glm::dvec3 groove{0};
    glm::dvec3 lag_m{0}; // tangential part of proxy - hand, which friction holds: proxy - hand = depth * normal + lag
};

// Whether what slid, and was held so, goes on to slide while the hand goes by `way_m`. It sticks where the hand has
// come back until less than `sticks_again` holds it: friction depends on displacement alone (Hayward and Armstrong
// 2000), not on how long the hand rests, which it does between the counts of its encoder, more often the higher the
// rate. Without dynamic friction it never does: what slid sticks again where it comes down anew.
bool slides_on(std::span<const Contact> held, const glm::dvec3& way_m, const Friction& friction) noexcept;

// Friction is a way that ends early, by the coefficient times what presses, or does not begin. The share of a way that
// remains; 0: it holds. What is left counts as none within `rounding`; else it slides from here on.
inline double share_past(const Friction& friction, double way, double pressed, double rounding, bool& sliding) noexcept
{
    const double rest = friction.static_coefficient, slide = friction.dynamic_coefficient;
    const double remaining = way - slide * pressed;
    const bool is_rounding = remaining <= rounding;
    if (way <= (sliding ? slide : rest) * pressed || (is_rounding && slide > 0)) return 0;
    sliding = sliding || !is_rounding;
    return remaining / way;
}

// Since construction or reset(). Queries of a ball count among the sweeps, boxes that it was handed among the
// triangles.
struct ContactCounters : CollisionCount {
    uint64_t walk_steps = 0; // features that a walk came over, rounds of a ball or a stylus
    uint64_t walks_cut = 0;  // ticks that reached a limit; the proxy is valid, or not yet put down, and goes on
};

inline ContactCounters operator+(const ContactCounters& a, const ContactCounters& b) noexcept
{
    return {{a.sweeps + b.sweeps, a.triangles_tested + b.triangles_tested},
            a.walk_steps + b.walk_steps,
            a.walks_cut + b.walks_cut};
}

inline ContactCounters operator-(const ContactCounters& a, const ContactCounters& b) noexcept
{
    return {{a.sweeps - b.sweeps, a.triangles_tested - b.triangles_tested},
            a.walk_steps - b.walk_steps,
            a.walks_cut - b.walks_cut};
}

// Torque (N m) about the grip of a force (N) that acts at a point.
inline glm::dvec3 torque_about(const glm::dvec3& grip_m, const glm::dvec3& point_m, const glm::dvec3& force_n)
{
    return glm::cross(point_m - grip_m, force_n);
}

} // namespace haptel::runtime
