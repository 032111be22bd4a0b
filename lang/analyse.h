// What the bounds of a texture say to its author: where it jumps or has a kink, and what may be undefined.
#pragma once

#include "lang/compile.h"
#include "lang/ir/bounds/bounds.h"

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace haptel::lang {

struct Analysis {
    ir::TextureBounds at_values;   // of the parameters
    ir::TextureBounds over_ranges; // wherever their ranges allow; those without a range at their values
    std::vector<ir::Interval> outputs, outputs_over_ranges; // the same of material outputs, by bit of Texture::writes
    bool no_jump_found = false; // not shown to be continuous, but no jump was found where one was sought
};

// A cube round the origin, wherever else the contact may be: any uv, any time, any normal. And how hard to look there.
struct AnalysedCube {
    double side_m = 0.2;
    double footprint_m = 0;                                                 // smallest wavelength worth rendering
    double normal_turn_max_per_m = std::numeric_limits<double>::infinity(); // of the surface: spectral norm of n_dp
    uint32_t evaluations = 4096;                                            // of the interval machine, for each bound
};

// A place where a height was seen to jump, by calling it: nothing where none was found. Empty: nobody looks.
struct SeenJump {
    double height_m; // > 0
    double p_m[3];
    double time_s;
};
using JumpSearch = std::function<std::optional<SeenJump>()>;

// `values` of the parameters by ir::Texture::parameters, SI, and images likewise; null or missing: any image. Says what
// it finds as diagnostics, not sorted: the warnings `jump`, `division`, `domain` and `scale` and the notes `kink` and
// `seam`; jumps and kinks where the values allow them, the others where the ranges do. `seek_jump` is asked where a
// height is not shown to be continuous: a jump that was seen is a warning, none a note.
Analysis analyse(const Program& program, const ir::Texture& texture, std::span<const double> values,
                 std::span<const ir::SplineImage* const> images, const AnalysedCube& where, Diagnostics& diagnostics,
                 const JumpSearch& seek_jump = {});

} // namespace haptel::lang
