// What holds one point of a probe off a surface: the tip of a point, a finger, an end of a stylus, the centre of a
// ball.
//
// On a clean mesh a point is held by the exact walk (walk_contact.h). Where faces cut each other, or objects are
// joined, a point is a ball of Lattice::point_radius (sphere_contact.h): it needs no links between the faces that it
// touches, and a slit that is narrower than the ball is closed to it.
//
// One servo thread owns a contact. A tick allocates nothing, never throws, and gives the same bits for the same
// sequence of poses. Poses are in the object's space, metres; what a stylus asks for is in lattice units.
#pragma once

#include "runtime/contact/contact.h"
#include "runtime/surface/surface.h"

#include <algorithm>
#include <memory>
#include <span>

namespace haptel::runtime {

class EndContact {
public:
    virtual ~EndContact() = default;

    // One tick. The first after construction or reset() puts the probe down where the hand is, wherever that is: a hand
    // that starts inside a closed object is inside it, free, and feels the wall from within. `tail`, lattice units: the
    // other end of a stylus, which is put down from there: a shaft that enters the object by a front side touches
    // there. One that comes out of it does not touch: its tail is inside.
    virtual void tick(const glm::dvec3& hand_m, const Friction& friction,
                      const glm::dvec3* tail = nullptr) noexcept = 0;
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
    virtual const ContactCounters& counters() const noexcept = 0;
    virtual const Surface& surface() const noexcept = 0;

    // For a stylus, which moves its ends several times in a tick and takes back what led astray. Lattice units.
    struct State {
        Proxy proxy;
        double grown = 0, lag = 0; // of a ball
    };
    virtual bool is_placed() const noexcept = 0;
    virtual const Proxy& proxy() const noexcept = 0;
    virtual glm::dvec3 beside() const noexcept = 0; // the lattice point next to the proxy, on its side
    virtual glm::dvec3 normal() const noexcept = 0; // of all its contacts together, unit
    // What of the way from where it aims to the proxy nobody feels: the radius of a ball that is a point.
    virtual glm::dvec3 unfelt() const noexcept { return glm::dvec3(0); }
    // What friction bears by over the depth along that normal: 1, but in a groove more.
    double bears() const noexcept
    {
        glm::dvec3 push_m(0);
        double pressed_m = 0;
        for (const Contact& contact : contacts()) {
            push_m += contact.depth_m * contact.normal;
            pressed_m += contact.pressed_m;
        }
        const double depth_m = glm::length(push_m);
        return pressed_m > (1 + 1e-9) * depth_m && depth_m > 0 ? pressed_m / depth_m : 1.0; // not by rounding
    }
    virtual void set_sliding(bool sliding) noexcept = 0;
    virtual void slide_on(const glm::dvec3& way_m, const Friction& friction) noexcept = 0; // a tick begins
    virtual void aim(const glm::dvec3& hand) noexcept = 0;
    // To where it aims; adds to `path` where it went, as far as it touched.
    virtual void go(const Friction& friction, WalkPath* path) noexcept = 0;
    virtual void restart(const glm::dvec3& at) noexcept = 0; // anew, at a free place
    virtual State state() const noexcept = 0;
    virtual void go_back(const State& to) noexcept = 0;
    // The contacts, as of where it is and where it aims; `lags`: friction holds it.
    virtual void describe(bool lags) noexcept = 0;
    virtual void count_tick() noexcept = 0;
};

// For a point on this surface.
std::unique_ptr<EndContact> make_point(const std::shared_ptr<const Surface>& surface, bool skips_free_space = true);

} // namespace haptel::runtime
