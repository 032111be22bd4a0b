// What the bounds of a texture say to its author: where it jumps or has a kink, and what may be undefined.
#pragma once

#include "lang/compile.h"
#include "lang/ir/bounds.h"

#include <span>

namespace haptel::lang {

struct Analysis {
    ir::TextureBounds at_values;   // of the parameters
    ir::TextureBounds over_ranges; // wherever their ranges allow; those without a range at their values
};

// In a cube of this side round the origin, wherever else the contact may be: any uv, any time. `values` of the
// parameters by ir::Texture::parameters, SI. Says what it finds as diagnostics, not sorted: the warnings `jump`,
// `division` and `domain` and the note `kink`; jumps and kinks where the values allow them, the others where the ranges
// do.
Analysis analyse(const Program& program, const ir::Texture& texture, std::span<const double> values, double side_m,
                 Diagnostics& diagnostics);

} // namespace haptel::lang
