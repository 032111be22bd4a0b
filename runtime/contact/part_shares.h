// Splits a contact between the objects that make it. On a joined surface a proxy in a crease, or on a ridge, may rest
// on several objects at once, and on a surface that pierces itself on several faces. Each gets the part of the
// contact's force that its own plane carries, so that it is felt with its own material, texture and shading, and its
// force begins and ends at 0 as the proxy moves.
#pragma once

#include "runtime/contact/contact.h"

#include <array>
#include <span>

namespace haptel::runtime {

class PartShares {
public:
    // A contact that one object (or one face) makes alone stays as it is. Any other becomes several at the same place,
    // one for each object, the largest first. Their depth_m * normal add up to that of the contact, and so do their
    // lag_m; no share pulls, and shares that oppose each other are bounded. At most 16 contacts; valid until the next
    // call.
    std::span<const Contact> of(const Surface& surface, std::span<const Contact> contacts) noexcept;

private:
    void add(const Surface& surface, const Contact& contact) noexcept;
    void settle(double along) noexcept;

    std::array<Contact, 16> contacts_;
    std::size_t count_ = 0;
};

} // namespace haptel::runtime
