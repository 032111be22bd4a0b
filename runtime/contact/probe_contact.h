// The contact of the scene's probe with one object, whatever the probe is. Object space, metres.
#pragma once

#include "runtime/contact/contact.h"
#include "runtime/contact/gripper_contact.h"
#include "runtime/contact/part_shares.h"
#include "runtime/contact/sphere_contact.h"
#include "runtime/contact/stylus_contact.h"
#include "runtime/hand/probe.h"

#include <memory>
#include <optional>
#include <span>
#include <variant>

namespace haptel::runtime {

class ProbeContact {
public:
    // `skips_free_space`: a probe that knows its clearance is spared queries. `rate_hz`: of the ticks.
    ProbeContact(const ProbeSettings& probe, const std::shared_ptr<const Surface>& surface,
                 bool skips_free_space = true, double rate_hz = 1000);

    // One tick: where it touches, none if it does not. Of a joined surface each is of one part, and where sheets
    // pierce each other of one of them.
    std::span<const Contact> update(const ProbePose& pose, const EndsFriction& friction) noexcept;
    // One tick of a probe that is free and known to have met nothing on its way.
    void follow(const ProbePose& pose) noexcept;

    void reset() noexcept;

    // A ball that overlaps what touches it by no more than `most_m` goes out of it, as far as the way is free. True: it
    // went, and the next tick tells.
    bool move_out(double most_m) noexcept;

    // Where it was held in the last tick, in which the hand was there: each place that touches by `off_m` off what it
    // touches. Nothing if it touched nothing.
    std::optional<ProbePose> held(const ProbePose& hand, double off_m) const noexcept;

    // Brings what the next tick may need into the cache. Returns how many faces it looked at.
    uint32_t read_ahead() const noexcept;

    // At least so far is it from any point of the probe to the nearest triangle; 0: not known.
    double gap_m(const ProbePose& pose) const noexcept;
    const ContactCounters& counters() const noexcept;

private:
    std::span<const Contact> contacts() const noexcept; // of the last tick, undivided
    std::span<const Contact> touched(const ProbePose& pose, const EndsFriction& friction) noexcept;

    const Surface* surface_;
    std::unique_ptr<PartShares> shares_; // of a joined surface, or one that pierces itself
    std::variant<PointContact, SphereContact, StylusContact, GripperContact> contact_;
};

} // namespace haptel::runtime
