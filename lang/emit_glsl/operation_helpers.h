// Operations of the IR that GLSL has no operator for: as lang/ir/semantics.h has them. Words in capitals stand for what
// helpers.cpp says. Whether a number is one is asked of its bits: a compiler of GLSL may take a - a for 0.
#pragma once

#include "lang/emit/helper_text.h"

namespace haptel::emit_glsl {

inline constexpr emit::HelperText operation_helpers[] = {
    {"haptel_is_nan", R"(bool haptel_is_nan(float a)
{
    return (floatBitsToUint(a) & 0x7fffffffu) > 0x7f800000u;
})"},
    {"haptel_is_finite", R"(bool haptel_is_finite(float a)
{
    return (floatBitsToUint(a) & 0x7f800000u) != 0x7f800000u;
})"},
    {"haptel_min", R"(float haptel_min(float a, float b)
{
    if (haptel_is_nan(a) || haptel_is_nan(b)) return uintBitsToFloat(0x7fc00000u);
    if (a == b) return uintBitsToFloat(floatBitsToUint(a) | floatBitsToUint(b));
    return a < b ? a : b;
})"},
    {"haptel_max", R"(float haptel_max(float a, float b)
{
    if (haptel_is_nan(a) || haptel_is_nan(b)) return uintBitsToFloat(0x7fc00000u);
    if (a == b) return uintBitsToFloat(floatBitsToUint(a) & floatBitsToUint(b));
    return a < b ? b : a;
})"},
    {"haptel_sign", R"(float haptel_sign(float a)
{
    return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a;
})"},
    {"haptel_mod", R"(float haptel_mod(float a, float b)
{
    haptel_precise float cells = b * floor(a / b);
    haptel_precise float rest = a - cells;
    return rest;
})"},
    {"haptel_length4", R"(float haptel_length4(float a, float b, float c, float d)
{
    float most = haptel_max(haptel_max(abs(a), abs(b)), haptel_max(abs(c), abs(d)));
    float scale = most > LARGE ? DOWN : most < SMALL ? UP : 1.0;
    float unscale = most > LARGE ? UP : most < SMALL ? DOWN : 1.0;
    haptel_precise float a1 = a * scale, b1 = b * scale, c1 = c * scale, d1 = d * scale;
    haptel_precise float sum = a1 * a1 + b1 * b1 + c1 * c1 + d1 * d1;
    return sqrt(sum) * unscale;
})"},
    {"haptel_length3", R"(float haptel_length3(float a, float b, float c)
{
    return haptel_length4(a, b, c, 0.0);
})"},
    {"haptel_length2", R"(float haptel_length2(float a, float b)
{
    return haptel_length4(a, b, 0.0, 0.0);
})"},
    {"haptel_sine_within_eighth", R"(float haptel_sine_within_eighth(float turns)
{
    haptel_precise float u = turns * turns;
    haptel_precise float sine = turns * (TURN_SINE);
    return sine;
})"},
    {"haptel_cosine_within_eighth", R"(float haptel_cosine_within_eighth(float turns)
{
    haptel_precise float u = turns * turns;
    haptel_precise float cosine = u * (TURN_COSINE) + 1.0;
    return cosine;
})"},
    {"haptel_sinturn", R"(float haptel_sinturn(float a)
{
    haptel_precise float way = a - roundEven(a), distance = abs(way);
    float folded = distance > 0.25 ? 0.5 - distance : distance;
    float size = folded > 0.125 ? haptel_cosine_within_eighth(0.25 - folded) : haptel_sine_within_eighth(folded);
    return way < 0.0 ? -size : size;
})"},
    {"haptel_costurn", R"(float haptel_costurn(float a)
{
    haptel_precise float way = a - roundEven(a), distance = abs(way);
    float folded = distance > 0.25 ? 0.5 - distance : distance;
    float size = folded > 0.125 ? haptel_sine_within_eighth(0.25 - folded) : haptel_cosine_within_eighth(folded);
    return distance > 0.25 ? -size : size;
})"},
    {"haptel_r_to_i", R"(uint haptel_r_to_i(float a)
{
    if (haptel_is_nan(a)) return 0u;
    if (a <= -2147483648.0) return 0x80000000u;
    if (a >= 2147483648.0) return 0x7fffffffu;
    return uint(int(a));
})"},
    {"haptel_r_to_u", R"(uint haptel_r_to_u(float a)
{
    if (haptel_is_nan(a) || a <= 0.0) return 0u;
    if (a >= 4294967296.0) return 0xffffffffu;
    return uint(a);
})"},
    {"haptel_idiv", R"(uint haptel_idiv(uint a, uint b)
{
    if (b == 0u) return 0u;
    if (b == 0xffffffffu) return 0u - a;
    return uint(int(a) / int(b));
})"},
    {"haptel_irem", R"(uint haptel_irem(uint a, uint b)
{
    if (b == 0u || b == 0xffffffffu) return 0u;
    return a - b * haptel_idiv(a, b); // GLSL leaves % of negative numbers open
})"},
};

} // namespace haptel::emit_glsl
