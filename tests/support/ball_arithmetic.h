// How an operation on balls rounds, and what it makes of balls that it maps monotonely, by steps or as a wave: the
// parts that operators, functions and the interpreter's operations on balls are put together from.
#pragma once

#include "tests/support/ball.h"

#include <limits>

namespace haptel::test {

// Rounding in units of half an ulp (2^-53 of the number): an IEEE operation makes one at most. Elementary functions are
// right to 2 ulp, many to 1 (Traits::ulp); turn forms to 2 beside the rounding of 2 pi.
inline constexpr int one_rounding = 1, library = 4;

// What operations round to.
struct Format {
    double half_ulp, least, largest, whole_beyond;
};
template <typename Real>
constexpr Format format_of()
{
    using Limits = std::numeric_limits<Real>;
    return {Limits::epsilon() / 2, Limits::denorm_min(), Limits::max(), 1 / double(Limits::epsilon())};
}
inline const Format& format()
{
    // A float may be rounded from a double that was rounded itself.
    static constexpr Format of_double = format_of<double>();
    static constexpr Format of_float = [] {
        Format format = format_of<float>();
        format.half_ulp *= 1 + 0x1p-20;
        return format;
    }();
    return Ball::in_singles ? of_float : of_double;
}

inline Quad infinite()
{
    return std::numeric_limits<Quad>::infinity();
}

// What an operation gives, rounded, whose exact result lies no further than `reach` from `middle`.
inline Ball rounded(const Quad& middle, const Quad& reach, int units = one_rounding)
{
    const Format& in = format();
    const Quad size = fabs(middle) + reach;
    if (!(size <= Quad(in.largest))) return {middle, infinite()};
    if (size == 0) return {middle, 0};
    return {middle, Quad(reach + units * (size * Quad(in.half_ulp) + Quad(in.least)))};
}

inline Quad low(const Ball& a)
{
    return a.middle - a.radius;
}
inline Quad high(const Ball& a)
{
    return a.middle + a.radius;
}

inline void decide(bool is_certain)
{
    if (!is_certain) Ball::undecided = true;
}

// How far the values at some places are from that in the middle; infinite where one is no number.
template <typename... Values>
Quad furthest(const Quad& middle, const Values&... values)
{
    Quad reach = 0;
    const auto consider = [&](const Quad& value) {
        const Quad off = fabs(Quad(value - middle));
        if (!(off <= reach)) reach = off == off ? off : infinite();
    };
    (consider(values), ...);
    return reach;
}

// Of a function whose furthest values lie at the ends, as those of a monotone one do.
template <typename Function>
Ball by_ends(const Ball& a, const Function& f, int units)
{
    const Quad middle = f(a.middle);
    return rounded(middle, a.radius == 0 ? Quad(0) : furthest(middle, f(low(a)), f(high(a))), units);
}

// Of one whose slope is at most 1, and `slope` in the middle, and whose curvature is at most 1: sine and cosine.
inline Ball of_wave(const Ball& a, const Quad& middle, const Quad& slope)
{
    const Quad near = fabs(slope) * a.radius + a.radius * a.radius / 2;
    return rounded(middle, near <= 2 ? near : Quad(2), library);
}

// Of a step function: the cell is the same wherever decisions are. Beyond 2^52 every double is whole.
template <typename Function>
Ball of_steps(const Ball& a, const Function& f)
{
    const Quad first = f(low(a)), last = f(high(a)); // of zeros the sign counts, as in Interpreter::decisions
    decide(a.radius == 0 || (first == last && signbit(first) == signbit(last)));
    const bool is_whole = !(fabs(a.middle) + a.radius < Quad(format().whole_beyond));
    return {f(a.middle), is_whole ? Quad(a.radius + 1) : Quad(0)};
}

inline bool are_apart(const Ball& a, const Ball& b)
{
    return (a.radius == 0 && b.radius == 0) || fabs(Quad(a.middle - b.middle)) > a.radius + b.radius;
}

// How far a product of what lies in both balls may be from that of their middles.
inline Quad reach_of_product(const Ball& a, const Ball& b)
{
    return fabs(a.middle) * b.radius + fabs(b.middle) * a.radius + a.radius * b.radius;
}

// The arithmetic of balls, as the interpreter's templates call it.
Ball operator-(const Ball& a);
Ball operator+(const Ball& a, const Ball& b);
Ball operator-(const Ball& a, const Ball& b);
Ball operator*(const Ball& a, const Ball& b);
Ball operator/(const Ball& a, const Ball& b);
bool operator<(const Ball& a, const Ball& b);
bool operator<=(const Ball& a, const Ball& b);
bool operator>(const Ball& a, const Ball& b);
bool operator>=(const Ball& a, const Ball& b);
bool operator==(const Ball& a, const Ball& b);
Ball fabs(const Ball& a);
Ball floor(const Ball& a);
Ball ceil(const Ball& a);
Ball trunc(const Ball& a);
Ball sqrt(const Ball& a);
Ball sin(const Ball& a);
Ball cos(const Ball& a);
Ball tan(const Ball& a);
Ball asin(const Ball& a);
Ball acos(const Ball& a);
Ball atan(const Ball& a);
Ball sinh(const Ball& a);
Ball cosh(const Ball& a);
Ball tanh(const Ball& a);
Ball asinh(const Ball& a);
Ball acosh(const Ball& a);
Ball atanh(const Ball& a);
Ball exp(const Ball& a);
Ball exp2(const Ball& a);
Ball log(const Ball& a);
Ball log2(const Ball& a);
Ball pow(const Ball& a, const Ball& b);
Ball atan2(const Ball& y, const Ball& x);
bool signbit(const Ball& a);
Ball copysign(const Ball& a, const Ball& sign);

} // namespace haptel::test
