#include "runtime/scene/object_effects.h"

#include <algorithm>

namespace haptel::runtime {

double ObjectEffects::reach_m() const
{
    return std::max({magnet.acts() ? magnet.reach_m : 0.0, damping_n_s_per_m > 0 ? damping_reach_m : 0.0,
                     vibration.acts() ? vibration_reach_m : 0.0});
}

} // namespace haptel::runtime
