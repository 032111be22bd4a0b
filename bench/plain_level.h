// What passes between the measurement and the plain C++ that is compiled once for each level of the instruction set:
// data alone, so that no function is shared between code of different flags.
#pragma once

#include "lang/abi/abi.h"

#include <array>
#include <cstdint>
#include <span>

namespace haptel::bench {

enum class Field : uint8_t { noise, perlin, fbm1, fbm2, fbm4, fbm8, gardner7 };

// The library's tables, so that heights are the same.
template <typename Real>
struct Tables {
    std::array<int32_t, 256> shuffle;
    std::array<Real, 256> gx, gy, gz; // by the shuffle's last number
};

// What an entry is called with.
template <typename Real>
struct PlainBlock {
    const Tables<Real>* tables;
    Real step;                // of differences, in wavelengths
    std::array<Real, 8> sine; // coefficients of x, x^3 ... of cpp_sine_N
};

// One way to get a height and a gradient, for one point and for many.
struct PlainEntry {
    const char* name; // cpp_analytic, cpp_dual, cpp_difference_2 | 4 | 6, cpp_sine_N of degree N
    bool is_f32, is_difference;
    int sine_degree; // 0: no polynomial
    haptel_entry* point;
    haptel_batch_entry* batch;
};

struct PlainLevel {
    const char *name, *flags; // "x86-64-v3", "-O3 ..."
    std::span<const PlainEntry> entries;
};

// Each of them is plain_level.cpp, compiled with the flags of bench/CMakeLists.txt.
namespace plain_base {
PlainLevel level(Field field);
}
namespace plain_v3 {
PlainLevel level(Field field);
}
namespace plain_v4 {
PlainLevel level(Field field);
}

} // namespace haptel::bench
