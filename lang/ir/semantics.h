// The meaning of every operation on numbers, once, for any real type T: the interpreter executes it, the builder folds
// constants by it, and code generation must agree with it bit for bit over double.
//
// Code for the elementary functions is made of templates over what code is made of (elementary_number.h), that for
// images calls spline.h; all else is in IEEE arithmetic rounded to nearest, in the order written here. fma, sqrt,
// floor, ceil, trunc and round-to-even are exact or correctly rounded, so that an instruction and the library agree.
// Bits of a NaN are not part of the meaning: no operation can see them.
#pragma once

#include "lang/ir/elementary_exact.h"
#include "lang/ir/ir.h"
#include "lang/math/elementary_constants.h"
#include "lang/math/spline.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace haptel::ir {

// One scalar of any type: `real` counts for reals, `bits` for integers (two's complement) and booleans (0 or 1),
// `image` for images (null: flat).
template <typename T>
struct Slot {
    T real{};
    uint32_t bits = 0;
    const haptel_image* image = nullptr;
};

// Of is_elementary(op), as interpreter, constant folding and bounds have it; b where it takes two. Total: at
// infinities, zeros and NaN what C99 says, but for atan2, which is 0 at the origin. How exact it is says Traits::ulp;
// tests/lang/math/elementary_test.cpp holds it to that.
double elementary_f64(Op op, double a, double b = 0);

namespace semantics {

template <typename T>
bool is_nan(const T& a)
{
    return !(a == a);
}

template <typename T>
bool is_finite(const T& a)
{
    return a - a == T(0);
}

// a - b. Boost's float takes a - (what was made in place) as -(that - a), and so turns the sign of a zero.
template <typename T>
T difference(const T& a, const T& b)
{
    return a - b;
}

template <typename T>
T minimum(const T& a, const T& b)
{
    using std::signbit;
    if (is_nan(a) || is_nan(b)) return a + b;
    if (a == b) return signbit(a) ? a : b;
    return a < b ? a : b;
}

template <typename T>
T maximum(const T& a, const T& b)
{
    using std::signbit;
    if (is_nan(a) || is_nan(b)) return a + b;
    if (a == b) return signbit(a) ? b : a;
    return a < b ? b : a;
}

// 0 of either sign and NaN are returned as they are.
template <typename T>
T sign(const T& a)
{
    return a > T(0) ? T(1) : a < T(0) ? T(-1) : a;
}

template <typename T>
T round_to_even(const T& a)
{
    using std::copysign, std::floor;
    if constexpr (std::is_same_v<T, double>) return std::nearbyint(a); // rounding is to nearest even in every thread
    T below = floor(a);
    T rest = a - below;
    if (!(rest == rest)) return a; // infinite or NaN
    T half = below / T(2);
    bool up = rest > T(0.5) || (rest == T(0.5) && floor(half) != half);
    return copysign(up ? below + T(1) : below, a);
}

template <typename T>
T fused_multiply_add(const T& a, const T& b, const T& c)
{
    if constexpr (std::is_same_v<T, double>) return std::fma(a, b, c);
    return a * b + c; // the oracle's T is so much finer that the second rounding does not matter
}

template <typename T>
T two_pi()
{
    using std::acos;
    static const T value = T(2) * acos(T(-1));
    return value;
}

// Scaled by a power of two only where squares could overflow or lose bits, so that the result is that of the plain
// formula everywhere else: m = max |x_i|, s = m > 2^500 ? 2^-600 : m < 2^-500 ? 2^600 : 1,
// sqrt(((x s)^2 + (y s)^2) + ...) (1 / s).
template <typename T>
T length(const T* x, int count)
{
    using std::fabs, std::sqrt;
    T m = fabs(x[0]);
    for (int i = 1; i < count; ++i) m = maximum(m, T(fabs(x[i])));
    T scale(1), unscale(1);
    if (m > T(0x1p500)) {
        scale = T(0x1p-600);
        unscale = T(0x1p600);
    } else if (m < T(0x1p-500)) {
        scale = T(0x1p600);
        unscale = T(0x1p-600);
    }
    T first = x[0] * scale;
    T sum = first * first;
    for (int i = 1; i < count; ++i) {
        T next = x[i] * scale;
        sum = sum + next * next;
    }
    return sqrt(sum) * unscale;
}

template <size_t count>
double polynomial(const double (&coefficients)[count], double u)
{
    double sum = coefficients[count - 1];
    for (size_t i = count - 1; i-- > 0;) sum = sum * u + coefficients[i];
    return sum;
}

template <typename T>
T sine_within_eighth(const T& turns)
{
    if constexpr (std::is_same_v<T, double>)
        return turns * polynomial(turn::sine_f64, turns * turns);
    else
        return sin(two_pi<T>() * turns);
}

template <typename T>
T cosine_within_eighth(const T& turns)
{
    if constexpr (std::is_same_v<T, double>)
        return turns * turns * polynomial(turn::cosine_f64, turns * turns) + 1;
    else
        return cos(two_pi<T>() * turns);
}

// Of a turn, exactly: the way to the nearest whole turn, and |way| to the nearest quarter.
template <typename T>
struct TurnParts {
    T way;
    bool is_behind_quarter; // |way| > 1/4
    bool is_near_quarter;   // nearer to 1/4 than to 0 and 1/2
    T to_quarter;

    explicit TurnParts(const T& a) : way(difference(a, T(round_to_even(a))))
    {
        using std::fabs;
        T folded = fabs(way);
        is_behind_quarter = folded > T(0.25);
        if (is_behind_quarter) folded = difference(T(0.5), folded);
        is_near_quarter = folded > T(0.125);
        to_quarter = is_near_quarter ? difference(T(0.25), folded) : folded;
    }
};

// Half turns give exactly 0 and quarter turns exactly 1.
template <typename T>
T sine_of_turns(const T& a)
{
    using std::signbit;
    const TurnParts<T> parts(a);
    const T size =
        parts.is_near_quarter ? cosine_within_eighth(parts.to_quarter) : sine_within_eighth(parts.to_quarter);
    return signbit(parts.way) ? T(-size) : size;
}

template <typename T>
T cosine_of_turns(const T& a)
{
    const TurnParts<T> parts(a);
    const T size =
        parts.is_near_quarter ? sine_within_eighth(parts.to_quarter) : cosine_within_eighth(parts.to_quarter);
    return parts.is_behind_quarter ? T(-size) : size;
}

// For is_elementary(op): exact functions of an oracle's number, and those of this project for double.
template <typename T>
T elementary_value(Op op, const T& a, const T& b)
{
    switch (op) {
#define ELEMENTARY(name, ...)                                                                                          \
    case Op::name: return exact::name(a);
#define ELEMENTARY2(name, ...)                                                                                         \
    case Op::name: return exact::name(a, b);
#define OP(name, ...)                                                                                                  \
    case Op::name: break;
#include "lang/ir/ops.def"
    }
    return a;
}

inline double elementary_value(Op op, double a, double b)
{
    return elementary_f64(op, a, b);
}

template <typename T>
uint32_t to_i32(const T& a)
{
    if (is_nan(a)) return 0;
    if (a <= T(-2147483648.0)) return 0x80000000u;
    if (a >= T(2147483647.0)) return 0x7fffffffu;
    return static_cast<uint32_t>(static_cast<int32_t>(a));
}

template <typename T>
uint32_t to_u32(const T& a)
{
    if (is_nan(a) || a <= T(0)) return 0;
    if (a >= T(4294967295.0)) return 0xffffffffu;
    return static_cast<uint32_t>(a);
}

inline uint32_t divide(int32_t a, int32_t b)
{
    if (b == 0) return 0;
    if (b == -1) return 0u - static_cast<uint32_t>(a);
    return static_cast<uint32_t>(a / b);
}

inline uint32_t remainder(int32_t a, int32_t b)
{
    return b == 0 || b == -1 ? 0 : static_cast<uint32_t>(a % b);
}

} // namespace semantics

// Executes `op` on up to three operands (length4: the fourth follows c in memory order a, b, c, d).
template <typename T>
inline void execute(Op op, Slot<T>& result, const Slot<T>& a, const Slot<T>& b, const Slot<T>& c, const Slot<T>& d)
{
    namespace s = semantics;
    using std::ceil, std::fabs, std::floor, std::sqrt, std::trunc;
    auto i32 = [](const Slot<T>& slot) { return static_cast<int32_t>(slot.bits); };
    switch (op) {
    case Op::add: result.real = a.real + b.real; return;
    case Op::sub: result.real = a.real - b.real; return;
    case Op::mul: result.real = a.real * b.real; return;
    case Op::div: result.real = a.real / b.real; return;
    case Op::neg: result.real = -a.real; return;
    case Op::fma: result.real = s::fused_multiply_add(a.real, b.real, c.real); return;
    case Op::min: result.real = s::minimum(a.real, b.real); return;
    case Op::max: result.real = s::maximum(a.real, b.real); return;
    case Op::abs: result.real = fabs(a.real); return;
    case Op::sign: result.real = s::sign(a.real); return;
    case Op::floor: result.real = floor(a.real); return;
    case Op::ceil: result.real = ceil(a.real); return;
    case Op::trunc: result.real = trunc(a.real); return;
    case Op::round: result.real = s::round_to_even(a.real); return;
    case Op::fract: result.real = s::difference(a.real, T(floor(a.real))); return;
    case Op::mod: result.real = s::difference(a.real, T(b.real * T(floor(T(a.real / b.real))))); return;
    case Op::sqrt: result.real = sqrt(a.real); return;
    case Op::length2:
    case Op::length3:
    case Op::length4: {
        const T x[] = {a.real, b.real, c.real, d.real};
        result.real = s::length(x, op == Op::length2 ? 2 : op == Op::length3 ? 3 : 4);
        return;
    }
    case Op::sinturn: result.real = s::sine_of_turns(a.real); return;
    case Op::costurn: result.real = s::cosine_of_turns(a.real); return;
#define ELEMENTARY(name, ...) case Op::name:
#include "lang/ir/ops.def"
        result.real = s::elementary_value(op, a.real, b.real);
        return;
    case Op::lt: result.bits = a.real < b.real; return;
    case Op::le: result.bits = a.real <= b.real; return;
    case Op::eq: result.bits = a.real == b.real; return;
    case Op::is_finite: result.bits = s::is_finite(a.real); return;
    case Op::ilt: result.bits = i32(a) < i32(b); return;
    case Op::ile: result.bits = i32(a) <= i32(b); return;
    case Op::ieq: result.bits = a.bits == b.bits; return;
    case Op::ult: result.bits = a.bits < b.bits; return;
    case Op::ule: result.bits = a.bits <= b.bits; return;
    case Op::ueq: result.bits = a.bits == b.bits; return;
    case Op::land: result.bits = a.bits & b.bits; return;
    case Op::lor: result.bits = a.bits | b.bits; return;
    case Op::lxor: result.bits = a.bits ^ b.bits; return;
    case Op::lnot: result.bits = a.bits ^ 1u; return;
    case Op::select: result = a.bits ? b : c; return;
    case Op::iadd: result.bits = a.bits + b.bits; return;
    case Op::isub: result.bits = a.bits - b.bits; return;
    case Op::imul: result.bits = a.bits * b.bits; return;
    case Op::idiv: result.bits = s::divide(i32(a), i32(b)); return;
    case Op::irem: result.bits = s::remainder(i32(a), i32(b)); return;
    case Op::iand: result.bits = a.bits & b.bits; return;
    case Op::ior: result.bits = a.bits | b.bits; return;
    case Op::ixor: result.bits = a.bits ^ b.bits; return;
    case Op::ishl: result.bits = a.bits << (b.bits & 31); return;
    case Op::ishr: result.bits = static_cast<uint32_t>(i32(a) >> (b.bits & 31)); return;
    case Op::imin: result.bits = i32(a) < i32(b) ? a.bits : b.bits; return;
    case Op::imax: result.bits = i32(a) < i32(b) ? b.bits : a.bits; return;
    case Op::udiv: result.bits = b.bits ? a.bits / b.bits : 0; return;
    case Op::urem: result.bits = b.bits ? a.bits % b.bits : 0; return;
    case Op::ushr: result.bits = a.bits >> (b.bits & 31); return;
    case Op::umin: result.bits = a.bits < b.bits ? a.bits : b.bits; return;
    case Op::umax: result.bits = a.bits < b.bits ? b.bits : a.bits; return;
    case Op::i_to_r: result.real = T(i32(a)); return;
    case Op::u_to_r: result.real = T(a.bits); return;
    case Op::r_to_i: result.bits = s::to_i32(a.real); return;
    case Op::r_to_u: result.bits = s::to_u32(a.real); return;
    case Op::i_as_u: result.bits = a.bits; return;
    case Op::u_as_i: result.bits = a.bits; return;
    case Op::b_to_i: result.bits = a.bits; return;
    case Op::spline: result.real = spline(a.image, b.real, c.real, d.bits); return;
    case Op::image_channel: result.image = image_channel(a.image, static_cast<int32_t>(b.bits)); return;
    case Op::image_coarser: result.image = image_coarser(a.image, static_cast<int32_t>(b.bits)); return;
    case Op::image_width: result.bits = static_cast<uint32_t>(image_width(a.image)); return;
    case Op::image_height: result.bits = static_cast<uint32_t>(image_height(a.image)); return;
    case Op::detach: result.real = a.real; return;
    }
}

} // namespace haptel::ir
