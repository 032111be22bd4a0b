// What one object does to a hand near it beside contact: as a scene states it. effects.h makes it felt.
#pragma once

#include "runtime/scene/magnet.h"
#include "runtime/scene/vibration.h"

#include <algorithm>

namespace haptel::runtime {

// Of one object. Viscosity and vibration are full while it is touched and fall off with the distance to it, to nothing
// at their reach; without one a vibration is felt in contact alone. A stylus is where its tip is: its shaft feels no
// more than the vibration of what it touches.
struct ObjectEffects {
    Magnet magnet;
    double damping_n_s_per_m = 0, damping_reach_m = 0; // >= 0; > 0 if it damps
    Vibration vibration;                               // its direction turns with the object
    double vibration_reach_m = 0;                      // >= 0

    bool act() const { return magnet.acts() || damping_n_s_per_m > 0 || vibration.acts(); }
    // From here on nothing of it is felt.
    double reach_m() const
    {
        return std::max({magnet.acts() ? magnet.reach_m : 0.0, damping_n_s_per_m > 0 ? damping_reach_m : 0.0,
                         vibration.acts() ? vibration_reach_m : 0.0});
    }
};

} // namespace haptel::runtime
