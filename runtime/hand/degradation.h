// What of a scene is left out of what a hand feels while its servo cannot keep its deadlines (overload.h). Each step
// leaves out what those before it do, too; what comes or goes fades, so that no step is felt as one.
#pragma once

#include <cstdint>

namespace haptel::runtime {

enum class Degradation : uint8_t {
    none,
    no_effects,  // pulls, media and vibrations
    no_textures, // bare surfaces: contact, stiffness, friction and damping
    no_force     // nothing, and the run ends
};

// One step on, one back; the last and the first stay.
inline Degradation next(Degradation step)
{
    return step == Degradation::no_force ? step : static_cast<Degradation>(static_cast<uint8_t>(step) + 1);
}
inline Degradation previous(Degradation step)
{
    return step == Degradation::none ? step : static_cast<Degradation>(static_cast<uint8_t>(step) - 1);
}

} // namespace haptel::runtime
