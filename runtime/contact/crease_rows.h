// The contacts of a point that rests on a crease: one for each smooth piece that meets there and bears a part.
//
// As one contact such a point is pushed from the hand to the proxy, which is right, but neither piece's shading normal
// is: the force would step where a smooth wall meets its floor. Row by row each piece is felt as beside the crease.
#pragma once

#include "runtime/contact/contact.h"

#include <array>
#include <span>

namespace haptel::runtime {

// Of all contacts of a probe, those on creases by their rows. The rows of one add up to what it was: their depths times
// their normals, and their lags. On a border, in a narrow groove, or at a vertex of more than `facets_most` facets, it
// stays one contact, as Contact::on_crease. At most 12 contacts, a stylus's; valid until the next call.
class CreaseRows {
public:
    static constexpr std::size_t rows_most = 24; // of its ends' six contacts three each, and its other six

    std::span<const Contact> of(const Surface& surface, std::span<const Contact> contacts) noexcept;

private:
    static constexpr std::size_t facets_most = 32;

    void add(const Surface& surface, const Contact& contact, std::size_t room) noexcept;

    std::array<Contact, rows_most> rows_;
    std::size_t count_ = 0;
};

} // namespace haptel::runtime
