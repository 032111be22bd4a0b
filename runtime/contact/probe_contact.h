// The contact of the scene's probe with one object, whatever the probe is. Object space, metres.
//
// A gripper is two points, each with a proxy of its own, held by one hand. Its tip is one finger, its tail the other;
// between them is nothing, so that an object fits there.
#pragma once

#include "runtime/contact/end_contact.h"
#include "runtime/contact/stylus_contact.h"
#include "runtime/hand/probe.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace haptel::runtime {

class ProbeContact {
public:
    // `rate_hz`: of the ticks.
    ProbeContact(const ProbeSettings& probe, const std::shared_ptr<const Surface>& surface, double rate_hz = 1000);

    // One tick: the contacts, none if the probe is free. On a joined surface each belongs to one object. Where neither
    // the pose nor the friction has changed, as between two counts of an encoder, all is as it was.
    std::span<const Contact> update(const ProbePose& pose, const EndsFriction& friction) noexcept;
    // One tick of a probe that is free and known to have met nothing on its way.
    void follow(const ProbePose& pose) noexcept;

    void reset() noexcept;

    // A ball that was put down where it overlaps the surface is felt with a smaller radius. If that lacks at most
    // `most_m`, this moves the ball out of the overlap as far as nothing is in the way. True: it moved, and the next
    // tick's contacts show it. Other probes: false.
    bool move_out(double most_m) noexcept;

    // The pose in which the surface held the probe in the last tick, whose hand was at `hand`; every place of contact
    // is moved `off_m` metres away from the surface. Nothing if the probe touched nothing.
    std::optional<ProbePose> held(const ProbePose& hand, double off_m) const noexcept;

    // Between two ticks: brings what the next one may need into the cache, and looks how far it is free around the
    // hand, which spares queries, if asked to. Changes no contact. Returns how many faces it looked at.
    uint32_t read_ahead(bool looks_around) noexcept;

    // A lower bound, in metres, of the distance from the probe in this pose to the nearest triangle; 0: not known.
    double gap_m(const ProbePose& pose) const noexcept;
    // False: update() reached a limit, and the next one goes on.
    bool settled() const noexcept { return settled_; }
    bool touches() const noexcept { return !contacts().empty(); }
    ContactCounters counters() const noexcept;                       // of all
    const ContactCounters& spent() const noexcept { return spent_; } // on the last update alone

private:
    std::span<const Contact> contacts() const noexcept; // of the last tick

    const Surface* surface_;
    bool by_planes_; // contacts know the normal of what holds them: of a ball, whatever it touches
    std::unique_ptr<StylusContact> stylus_;
    std::unique_ptr<EndContact> tip_, tail_; // of a stylus none; the tail of a gripper alone
    std::array<Contact, 6> of_fingers_;      // of a gripper's each three
    std::size_t of_fingers_count_ = 0;
    ProbePose pose_; // of the last tick
    EndsFriction friction_;
    ContactCounters spent_;
    bool settled_ = false;
};

} // namespace haptel::runtime
