#include "runtime/contact/gripper_contact.h"

#include <algorithm>

namespace haptel::runtime {

GripperContact::GripperContact(const std::shared_ptr<const Surface>& surface)
    : tip_(make_point(surface)), tail_(make_point(surface))
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
    return contacts();
}

void GripperContact::follow(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept
{
    tip_->follow(tip_m);
    tail_->follow(tail_m);
    count_ = 0;
}

void GripperContact::reset() noexcept
{
    tip_->reset();
    tail_->reset();
    count_ = 0;
}

double GripperContact::gap_m(const glm::dvec3& tip_m, const glm::dvec3& tail_m) const noexcept
{
    return std::min(tip_->gap_m(tip_m), tail_->gap_m(tail_m));
}

} // namespace haptel::runtime
