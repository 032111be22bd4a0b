// Operations of the IR that C has no operator for: as lang/ir/semantics.h has them. In the
// text `real` is double or float, $ the ending of that type's functions in <math.h>, and what is in capitals one of the
// numbers in helpers.cpp.
#pragma once

#include "lang/emit/helper_text.h"

namespace haptel::emit_c {

inline constexpr emit::HelperText operation_helpers[] = {
    {"haptel_min", R"(static real haptel_min(const real a, const real b)
{
    if (a != a || b != b) return a + b;
    if (a == b) return signbit(a) ? a : b;
    return a < b ? a : b;
})"},
    {"haptel_max", R"(static real haptel_max(const real a, const real b)
{
    if (a != a || b != b) return a + b;
    if (a == b) return signbit(a) ? b : a;
    return a < b ? b : a;
})"},
    {"haptel_sign", R"(static real haptel_sign(const real a)
{
    return a > 0 ? 1 : a < 0 ? -1 : a;
})"},
    {"haptel_mod", R"(static real haptel_mod(const real a, const real b)
{
    const real whole = floor$(a / b), cells = b * whole;
    return a - cells;
})"},
    {"haptel_length", R"(static real haptel_length(const real* const x, const int count)
{
    real most = fabs$(x[0]), scale = 1, unscale = 1, sum;
    int i;
    for (i = 1; i < count; ++i) most = haptel_max(most, fabs$(x[i]));
    if (most > LARGE) {
        scale = DOWN;
        unscale = UP;
    } else if (most < SMALL) {
        scale = UP;
        unscale = DOWN;
    }
    sum = x[0] * scale;
    sum = sum * sum;
    for (i = 1; i < count; ++i) {
        const real scaled = x[i] * scale, square = scaled * scaled;
        sum = sum + square;
    }
    return sqrt$(sum) * unscale;
})"},
    {"haptel_length2", R"(static real haptel_length2(const real a, const real b)
{
    real x[2];
    x[0] = a;
    x[1] = b;
    return haptel_length(x, 2);
})"},
    {"haptel_length3", R"(static real haptel_length3(const real a, const real b, const real c)
{
    real x[3];
    x[0] = a;
    x[1] = b;
    x[2] = c;
    return haptel_length(x, 3);
})"},
    {"haptel_length4", R"(static real haptel_length4(const real a, const real b, const real c, const real d)
{
    real x[4];
    x[0] = a;
    x[1] = b;
    x[2] = c;
    x[3] = d;
    return haptel_length(x, 4);
})"},
    {"haptel_polynomial", R"(static real haptel_polynomial(const real* const coefficients, int count, const real x)
{
    real sum = coefficients[--count];
    while (count > 0) {
        const real product = sum * x;
        sum = product + coefficients[--count];
    }
    return sum;
})"},
    {"haptel_sine_within_eighth", R"(static real haptel_sine_within_eighth(const real turns)
{
    static const real coefficients[] = {TURN_SINE};
    return turns * haptel_polynomial(coefficients, (int)(sizeof coefficients / sizeof(real)), turns * turns);
})"},
    {"haptel_cosine_within_eighth", R"(static real haptel_cosine_within_eighth(const real turns)
{
    static const real coefficients[] = {TURN_COSINE};
    const real square = turns * turns;
    const real rest = square * haptel_polynomial(coefficients, (int)(sizeof coefficients / sizeof(real)), square);
    return rest + 1;
})"},
    {"haptel_sinturn", R"(static real haptel_sinturn(const real a)
{
    const real way = a - nearbyint$(a), distance = fabs$(way);
    const real folded = distance > (real)0.25 ? (real)0.5 - distance : distance;
    const real size = folded > (real)0.125 ? haptel_cosine_within_eighth((real)0.25 - folded)
                                           : haptel_sine_within_eighth(folded);
    return signbit(way) ? -size : size;
})"},
    {"haptel_costurn", R"(static real haptel_costurn(const real a)
{
    const real way = a - nearbyint$(a), distance = fabs$(way);
    const real folded = distance > (real)0.25 ? (real)0.5 - distance : distance;
    const real size = folded > (real)0.125 ? haptel_sine_within_eighth((real)0.25 - folded)
                                           : haptel_cosine_within_eighth(folded);
    return distance > (real)0.25 ? -size : size;
})"},
    {"haptel_r_to_i", R"(static uint32_t haptel_r_to_i(const real a)
{
    if (a != a) return 0;
    if (a <= (real)-2147483648.0) return 0x80000000u;
    if (a >= (real)2147483647.0) return 0x7fffffffu;
    return (uint32_t)(int32_t)a;
})"},
    {"haptel_r_to_u", R"(static uint32_t haptel_r_to_u(const real a)
{
    if (a != a || a <= 0) return 0;
    if (a >= (real)4294967295.0) return 0xffffffffu;
    return (uint32_t)a;
})"},
    {"haptel_idiv", R"(static uint32_t haptel_idiv(const uint32_t a, const uint32_t b)
{
    if (b == 0) return 0;
    if (b == 0xffffffffu) return 0u - a;
    return (uint32_t)((int32_t)a / (int32_t)b);
})"},
    {"haptel_irem", R"(static uint32_t haptel_irem(const uint32_t a, const uint32_t b)
{
    if (b == 0 || b == 0xffffffffu) return 0;
    return (uint32_t)((int32_t)a % (int32_t)b);
})"},
};

} // namespace haptel::emit_c
