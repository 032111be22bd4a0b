// Where several parts of a joined surface hold the proxy at once, in a crease or on a ridge between them, or several
// sheets that pierce each other: what each of them holds, so that each is felt with its own material, texture and
// shading and none of them begins or ends with a step.
#pragma once

#include "runtime/contact/contact.h"

#include <array>
#include <span>

namespace haptel::runtime {

class PartShares {
public:
    // Each contact as it is if one part alone, or one sheet, holds the proxy there, else one for each, at the same
    // place, what holds most first. Depths times normals add up to what they were, and so does the lag. What they push
    // against each other is bounded.
    std::span<const Contact> of(const Surface& surface, std::span<const Contact> contacts) noexcept;

private:
    void add(const Surface& surface, const Contact& contact) noexcept;
    void settle(double along) noexcept;

    std::array<Contact, 16> contacts_;
    std::size_t count_ = 0;
};

} // namespace haptel::runtime
