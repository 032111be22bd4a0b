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

} // namespace haptel::runtime
