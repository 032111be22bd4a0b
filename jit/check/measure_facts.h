// What facts a height has over a box, as far as a search sees: for whoever states facts that the compiler cannot find.
//
// Random places, and from the best of them uphill. Nothing is proven: what lies higher where nobody looked is missed,
// so a measured range is never too wide and may be too narrow. A figure that grows without end toward a place is none.
#pragma once

#include "jit/check/check_gradient.h"

#include <cstdint>
#include <optional>

namespace haptel::jit {

// Places at which a search begins. With as many two searches of a noise agree to some per cent.
inline constexpr uint32_t default_search_points = 20'000;

struct MeasuredFacts {
    double value_minimum = 0, value_maximum = 0; // metres
    std::optional<double> slope;                 // greatest length of the gradient; none: without end
    std::optional<double> curvature; // greatest change of it, per metre, of the smooth pieces; none as before
    uint32_t continuity = HAPTEL_CONTINUITY_C1; // HAPTEL_CONTINUITY_*: as rough as it was met
    double faulty = 0;                          // share of the places where it is not finite; they are left out
};

// Of code in f64.
MeasuredFacts measure_facts(const TextureBinding& binding, const CheckBox& box, uint32_t points = default_search_points,
                            uint64_t seed = 1);

} // namespace haptel::jit
