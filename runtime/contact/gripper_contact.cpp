#include "runtime/contact/gripper_contact.h"

#include <algorithm>

namespace haptel::runtime {

GripperContact::GripperContact(const std::shared_ptr<const Surface>& surface, bool skips_free_space)
    : tip_(make_point(surface, skips_free_space)), tail_(make_point(surface, skips_free_space))
{
}

std::span<const Contact> GripperContact::update(const glm::dvec3& tip_m, const glm::dvec3& tail_m,
                                                const EndsFriction& friction) noexcept
{
    tip_->tick(tip_m, friction.tip);
    tail_->tick(tail_m, friction.tail);
    count_ = 0;
    for (const Contact& contact : tip_->contacts()) contacts_[count_++] = contact;
    for (const Contact& contact : tail_->contacts()) {
        contacts_[count_] = contact;
        contacts_[count_++].along = 1;
    }
    count();
    return contacts();
}

void GripperContact::follow(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    tip_->follow(tip_m);
    tail_->follow(tail_m);
    count_ = 0;
    count();
}

void GripperContact::reset() noexcept
{
    tip_->reset();
    tail_->reset();
    count_ = 0;
    counters_ = {};
    skipped_before_ = 0;
}

double GripperContact::gap_m(const glm::dvec3& tip_m, const glm::dvec3& tail_m) const noexcept
{
    return std::min(tip_->gap_m(tip_m), tail_->gap_m(tail_m));
}

void GripperContact::count() noexcept
{
    const ContactCounters &a = tip_->counters(), &b = tail_->counters();
    counters_.skipped += a.skipped + b.skipped == skipped_before_ + 2;
    skipped_before_ = a.skipped + b.skipped;
    ++counters_.ticks;
    counters_.touching_ticks += count_ > 0;
    counters_.sweeps = a.sweeps + b.sweeps;
    counters_.object_boxes_missed = a.object_boxes_missed + b.object_boxes_missed;
    counters_.triangles_tested = a.triangles_tested + b.triangles_tested;
    counters_.walk_steps = a.walk_steps + b.walk_steps;
    counters_.walk_steps_max = std::max(a.walk_steps_max, b.walk_steps_max);
    counters_.walks_cut = a.walks_cut + b.walks_cut;
    counters_.hands_held = std::max(a.hands_held, b.hands_held);
}

} // namespace haptel::runtime
