// What a proxy may need in its next tick, asked for while there is time: on a mesh that no cache holds, waiting for the
// next face's data is most of what a step onto it takes.
#pragma once

#include "runtime/surface/surface.h"

namespace haptel::runtime {

// Brings the faces around this one, and those around these, into the cache. Returns how many faces it looked at.
uint32_t read_ahead(const Surface& surface, uint32_t face, uint32_t side) noexcept;

} // namespace haptel::runtime
