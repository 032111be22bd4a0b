// Bits of numbers, and angles of any size, in C text: as lang/math/elementary_angle.cpp has them, without 128-bit
// integers.
#pragma once

#include "lang/emit/helper_text.h"

namespace haptel::emit_c {

inline constexpr emit::HelperText angle_helpers[] = {
    {"haptel_bits64", R"(static uint64_t haptel_bits64(const double a)
{
    uint64_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
})"},
    {"haptel_real64", R"(static double haptel_real64(const uint64_t bits)
{
    double a;
    memcpy(&a, &bits, sizeof a);
    return a;
})"},
    {"haptel_bits32", R"(static uint32_t haptel_bits32(const float a)
{
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
})"},
    {"haptel_real32", R"(static float haptel_real32(const uint32_t bits)
{
    float a;
    memcpy(&a, &bits, sizeof a);
    return a;
})"},
    {"haptel_product",
     R"(static void haptel_product(const uint64_t a, const uint64_t b, uint64_t* const high, uint64_t* const low)
{
    const uint64_t half = 0xffffffffu, a0 = a & half, a1 = a >> 32, b0 = b & half, b1 = b >> 32;
    const uint64_t lowest = a0 * b0, first = a1 * b0 + (lowest >> 32), second = a0 * b1 + (first & half);
    *high = a1 * b1 + (first >> 32) + (second >> 32);
    *low = second << 32 | (lowest & half);
})"},
    {"haptel_two_over_pi", R"(static uint64_t haptel_two_over_pi(const int first_bit)
{
    static const uint64_t words[] = {TWO_OVER_PI};
    const uint64_t* const word = words + first_bit / 64;
    const int shift = first_bit % 64;
    return shift == 0 ? word[0] : word[0] << shift | word[1] >> (64 - shift);
})"},
    {"haptel_reduce_angle",
     R"(/* Any angle from 2^20 on as quarter turns, whole, and a rest in two parts: its product with 192 bits of 2 / pi. */
static void haptel_reduce_angle(const double angle, double* const quarters, double* const high, double* const low)
{
    const uint64_t word = haptel_bits64(angle), one = 1, significand = (word & ((one << 52) - 1)) | one << 52;
    const int first = (int)(word >> 52) - 1075 - 2 + 64;
    uint64_t lowest_high, lowest_low, middle_high, middle_low, upper, lower, turns;
    int is_beyond_half, zeros = 0;
    *quarters = *high = *low = (double)NAN;
    if (!(angle <= 1.7976931348623157e308)) return;
    haptel_product(significand, haptel_two_over_pi(first + 128), &lowest_high, &lowest_low);
    haptel_product(significand, haptel_two_over_pi(first + 64), &middle_high, &middle_low);
    lower = middle_low + lowest_high;
    upper = significand * haptel_two_over_pi(first) + middle_high + (uint64_t)(lower < middle_low);
    turns = upper >> 62;
    upper = upper << 2 | lower >> 62;
    lower = lower << 2 | lowest_low >> 62;
    is_beyond_half = (upper >> 63) != 0;
    if (is_beyond_half) {
        ++turns;
        lower = 0u - lower;
        upper = ~upper + (uint64_t)(lower == 0);
    }
    while (zeros < 127 && (upper >> 63) == 0) {
        upper = upper << 1 | lower >> 63;
        lower <<= 1;
        ++zeros;
    }
    {
        const double sign = is_beyond_half ? -1.0 : 1.0;
        const double of_quarter = ldexp(sign * (double)(upper >> 11), -53 - zeros);
        const double rest_of_quarter = ldexp(sign * (double)(upper << 53 | lower >> 11), -117 - zeros);
        const double part_high = haptel_real64(haptel_bits64(of_quarter) & ~(uint64_t)0x7ffffff);
        const double part_low = of_quarter - part_high;
        const double product0 = of_quarter * QUARTER_REST, product1 = rest_of_quarter * QUARTER_UPPER;
        const double product2 = part_low * QUARTER_UPPER, product3 = part_high * QUARTER_UPPER;
        const double others = product2 + (product0 + product1);
        *quarters = (double)turns;
        *high = product3 + others;
        *low = (product3 - *high) + others;
    }
})"},
};

} // namespace haptel::emit_c
