// A gripper of two fingers: two points, each with a proxy of its own, held by one hand. Its tip is one finger, its tail
// the other; between them is nothing, so that an object fits there.
#pragma once

#include "runtime/contact/end_contact.h"

#include <memory>
#include <span>

namespace haptel::runtime {

class GripperContact {
public:
    explicit GripperContact(const std::shared_ptr<const Surface>& surface);

    // One tick: where its fingers touch, the tip first. A finger whose pose is not finite is held where it was.
    std::span<const Contact> update(const glm::dvec3& tip_m, const glm::dvec3& tail_m,
                                    const EndsFriction& friction = {}) noexcept;
    // One tick of a probe that is free and known to have met nothing on its way.
    void follow(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept;
    // Between two ticks, as EndContact's.
    void look_around() noexcept { tip_->look_around(), tail_->look_around(); }

    void reset() noexcept;

    // At least so far is it from a finger to the nearest triangle; 0: not known.
    double gap_m(const glm::dvec3& tip_m, const glm::dvec3& tail_m) const noexcept;

    std::span<const Contact> contacts() const noexcept { return {contacts_, count_}; }
    // Of both fingers.
    ContactCounters counters() const noexcept { return tip_->counters() + tail_->counters(); }

private:
    std::unique_ptr<EndContact> tip_, tail_;
    Contact contacts_[6]; // of each finger three
    std::size_t count_ = 0;
};

} // namespace haptel::runtime
