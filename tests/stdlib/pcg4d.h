// pcg4d as its authors publish it (Jarzynski and Olano, Hash Functions for GPU Rendering, 2020): the twin of
// hash.haptel.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace haptel::test {

using Four = std::array<uint32_t, 4>;

inline Four pcg4d(Four v)
{
    for (uint32_t& part : v) part = part * 1664525u + 1013904223u;
    const auto mix = [&] {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
    };
    mix();
    for (uint32_t& part : v) part ^= part >> 16;
    mix();
    return v;
}

inline Four pcg4d(int32_t i, int32_t j, int32_t k, int32_t l)
{
    return pcg4d(
        {static_cast<uint32_t>(i), static_cast<uint32_t>(j), static_cast<uint32_t>(k), static_cast<uint32_t>(l)});
}

// The 24 upper bits as a number in 0 .. 1.
inline double unit_of(uint32_t bits)
{
    return std::ldexp(bits >> 8, -24);
}

} // namespace haptel::test
