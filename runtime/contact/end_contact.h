// What holds one point of a probe off a surface: the tip of a point, a finger, the centre of a ball.
//
// On a clean mesh a point is held by the exact walk (walk_contact.h). Where faces cut each other, or objects are
// joined, a point is a ball of Lattice::point_radius (sphere_contact.h): it needs no links between the faces that it
// touches, and a slit that is narrower than the ball is closed to it.
//
// One servo thread owns a contact. A tick allocates nothing, never throws, and gives the same bits for the same
// sequence of poses. Poses are in the object's space, metres.
#pragma once

#include "runtime/contact/contact.h"
#include "runtime/surface/surface.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace haptel::runtime {

// Free space around a probe: no triangle is within `radius` of where it was. While it stays inside there is nothing to
// collide with; once it has left, its way back is not known. Lattice units.
template <class Place>
struct Clearance {
    Place at{};
    double radius = 0, next_radius = 0.25 * Lattice::extent; // to try when it was left
    double unspared = -1; // the way of a free tick that it did not spare a query; < 0: there was none

    bool spares(double from_there) noexcept
    {
        if (!(from_there < radius)) radius = 0;
        return radius > 0;
    }
    // Between two ticks, of a probe that is free `here`: free_within(radius) says how much of that is free. Larger
    // after success and smaller after failure, and not at all where four ticks would cross even a success.
    template <class FreeWithin>
    void look(const Place& here, FreeWithin&& free_within) noexcept
    {
        const double step = std::exchange(unspared, -1);
        if (step < 0) return;
        const bool pays = next_radius >= 4 * step;
        if (pays) at = here, radius = free_within(next_radius);
        next_radius = !pays        ? 1.1 * next_radius
                      : radius > 0 ? std::min(1.4 * radius, Lattice::extent)
                                   : 0.5 * next_radius;
    }
};

class EndContact {
public:
    virtual ~EndContact() = default;

    // One tick. The first after construction or reset() puts the probe down where the hand is, wherever that is: a hand
    // that starts inside a closed object is inside it, free, and feels the wall from within.
    virtual void tick(const glm::dvec3& hand_m, const Friction& friction) noexcept = 0;
    const Contact& update(const glm::dvec3& hand_m, const Friction& friction = {}) noexcept
    {
        tick(hand_m, friction);
        return contact();
    }
    // One tick of a probe that is free and known to have met nothing on its way: the same, for nothing.
    virtual void follow(const glm::dvec3& hand_m) noexcept = 0;
    // Between two ticks: looks how far it is free around a hand that the last tick could not spare a query. For ticks
    // to come; changes no contact.
    virtual void look_around() noexcept {}
    virtual void reset() noexcept = 0;
    // A ball that was put down smaller, for what it overlapped there, goes out of that as far as the way is free, and
    // grows by as much; one that lacks more than `most_m` of its radius stays. True: it went, and the next tick tells.
    virtual bool move_out(double /*most_m*/) noexcept { return false; }

    // At least so far is it from the probe to the nearest triangle; 0: not known.
    virtual double gap_m(const glm::dvec3& hand_m) const noexcept = 0;

    // Of the last tick: where it touches, at most three places, the one that presses most first.
    virtual std::span<const Contact> contacts() const noexcept = 0;
    // The first of them; if it touches nothing, where the hand is.
    virtual const Contact& contact() const noexcept = 0;
    const ContactCounters& counters() const noexcept { return counters_; }

    virtual const Proxy& proxy() const noexcept = 0; // lattice units

protected:
    ContactCounters counters_;
};

// For a point on this surface.
std::unique_ptr<EndContact> make_point(const std::shared_ptr<const Surface>& surface);

} // namespace haptel::runtime
