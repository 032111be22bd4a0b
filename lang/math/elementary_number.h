// What the elementary functions compute with: an IEEE number in steps that a code generator can write as instructions.
//
// Every function of elementary_*.h is a template over its number R and uses only this vocabulary: + - * / and a
// comparison, each rounded once to nearest; `select`, which takes either value and has evaluated both; bits and back;
// and `reduce_where`, the one rare branch. So Number (interpreter, constant folding) and jit's Code (one point, or
// lanes side by side) have the same bits by construction, on every processor.
//
// No fma: without the instruction (baseline x86-64) each one is a call, sixteen of them for a vector, and where
// exactness matters a product of halves of a significand is exact as it is.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace haptel::ir::elementary {

template <typename Float>
struct Format;

template <>
struct Format<double> {
    using Bits = uint64_t;
    static constexpr int width = 64, digits = 52, bias = 1023;
    static constexpr Bits low_half = (Bits{1} << 27) - 1; // of the significand; the upper has 26 bits
    static constexpr double rounder = 0x1.8p52; // x + rounder has the whole number nearest to x in its low bits
    static constexpr double smallest_normal = 0x1p-1022, largest = 0x1.fffffffffffffp1023;
};

template <>
struct Format<float> {
    using Bits = uint32_t;
    static constexpr int width = 32, digits = 23, bias = 127;
    static constexpr Bits low_half = (Bits{1} << 12) - 1; // the upper has 12 bits
    static constexpr double rounder = 0x1.8p23;
    static constexpr double smallest_normal = 0x1p-126, largest = 0x1.fffffep127;
};

// An angle as a multiple of a quarter turn, whole, and what is left: |high + low| <= pi / 4 (1 + 2^-20).
template <typename R>
struct Angle {
    R quarters, high, low;
};

// The same for angles of any size, those of 2^20 and less skipped; of infinity and NaN all is NaN. The exact value of
// the angle counts, by as many bits of 2 / pi as that takes.
void reduce_huge_angles(const double* angles, uint32_t count, double* quarters, double* high, double* low);

template <typename F>
class Number {
public:
    using Float = F;
    using Bits = typename Format<F>::Bits;
    static constexpr bool is_single = sizeof(F) == sizeof(float);

    F value;

    template <typename Real, typename = std::enable_if_t<std::is_arithmetic_v<Real>>>
    Number(Real number) : value(static_cast<F>(number))
    {
    }

    friend Number operator+(Number a, Number b) { return a.value + b.value; }
    friend Number operator-(Number a, Number b) { return a.value - b.value; }
    friend Number operator*(Number a, Number b) { return a.value * b.value; }
    friend Number operator/(Number a, Number b) { return a.value / b.value; }
    friend Number operator-(Number a) { return -a.value; }
    friend bool operator<(Number a, Number b) { return a.value < b.value; }
    friend bool operator>(Number a, Number b) { return a.value > b.value; }
    friend bool operator==(Number a, Number b) { return a.value == b.value; }

    friend Number abs(Number a) { return std::fabs(a.value); }
    friend Number sqrt(Number a) { return std::sqrt(a.value); }
    friend Number select(bool condition, Number a, Number b) { return condition ? a : b; }
    friend Number constant(Number, double number) { return {number}; }

    friend Bits bits(Number a) { return std::bit_cast<Bits>(a.value); }
    friend Number with_bits(Number, Bits bits) { return std::bit_cast<F>(bits); }

    friend Number<float> narrow(Number a) { return a.value; }
    friend Number<double> widen(Number a) { return a.value; }

    friend void reduce_where(bool condition, Number a, Angle<Number>& angle)
    {
        if (!condition) return;
        const double number = a.value;
        double quarters = 0, high = 0, low = 0;
        reduce_huge_angles(&number, 1, &quarters, &high, &low);
        angle = {quarters, high, low};
    }
};

inline bool is_set(uint64_t word)
{
    return word != 0;
}

} // namespace haptel::ir::elementary
