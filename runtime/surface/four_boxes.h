// Half of a node's boxes at once: the processor's own vectors, which g++ and clang have for every processor.
#pragma once

#include "runtime/surface/box_tree.h"

#include <cstdint>

namespace haptel::runtime {

using Four = float __attribute__((vector_size(16), may_alias));
using FourBits = int32_t __attribute__((vector_size(16)));
constexpr uint32_t half = 4;
static_assert(BoxTree::width == 2 * half);

inline Four four(const float* first)
{
    return *reinterpret_cast<const Four*>(first);
}
inline Four all_of(float value)
{
    return Four{value, value, value, value};
}
inline Four least(Four a, Four b)
{
    return a < b ? a : b;
}
inline Four most_of(Four a, Four b)
{
    return a > b ? a : b;
}

// One for each of a node's boxes, the first the lowest.
inline uint32_t bits(FourBits first, FourBits second)
{
    const FourBits both = (first & FourBits{1, 2, 4, 8}) | (second & FourBits{16, 32, 64, 128});
    return uint32_t(both[0] | both[1] | both[2] | both[3]);
}

} // namespace haptel::runtime
