// What holds the probe on one smooth piece of an object, made one contact.
//
// A ball in a smooth hollow, or a point that is held as a ball, rests on several facets of one surface. They stand for
// one place of it: from the hand they all have the same foot (runtime/force/foot.h). As one contact they are felt as
// that place; one by one they would be felt as places beside it.
#pragma once

#include "runtime/contact/crease_rows.h"
#include "runtime/contact/project.h"
#include "runtime/force/foot.h"

#include <array>
#include <span>

namespace haptel::runtime {

class SmoothRows {
public:
    // Of one object, in its space. `way_m`: from the hand to the proxy by all that holds the probe. Valid until the
    // next call.
    std::span<const Contact> of(const Surface& surface, std::span<const Contact> contacts, const Shaft& way_m,
                                FacetLines& lines) noexcept;

private:
    std::array<Contact, CreaseRows::rows_most> rows_;
};

} // namespace haptel::runtime
