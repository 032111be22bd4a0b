#include "tests/support/ball.h"

#include "lang/ir/run/interpret_machine.h"

#include <algorithm>
#include <limits>

namespace haptel::test {
namespace {

// Rounding in units of half an ulp (2^-53 of the number): an IEEE operation makes one at most. Elementary functions are
// right to 2 ulp, many to 1 (Traits::ulp); turn forms to 2 beside the rounding of 2 pi.
constexpr int one_rounding = 1, library = 4;

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
const Format& format()
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

Quad infinite()
{
    return std::numeric_limits<Quad>::infinity();
}

// What an operation gives, rounded, whose exact result lies no further than `reach` from `middle`.
Ball rounded(const Quad& middle, const Quad& reach, int units = one_rounding)
{
    const Format& in = format();
    const Quad size = fabs(middle) + reach;
    if (!(size <= Quad(in.largest))) return {middle, infinite()};
    if (size == 0) return {middle, 0};
    return {middle, Quad(reach + units * (size * Quad(in.half_ulp) + Quad(in.least)))};
}

Quad low(const Ball& a)
{
    return a.middle - a.radius;
}
Quad high(const Ball& a)
{
    return a.middle + a.radius;
}

void decide(bool is_certain)
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
Ball of_wave(const Ball& a, const Quad& middle, const Quad& slope)
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

bool are_apart(const Ball& a, const Ball& b)
{
    return (a.radius == 0 && b.radius == 0) || fabs(Quad(a.middle - b.middle)) > a.radius + b.radius;
}

} // namespace

thread_local bool Ball::undecided = false;
thread_local bool Ball::in_singles = false;

bool Ball::may_be(double found) const
{
    return fabs(Quad(Quad(found) - middle)) <= radius;
}

Ball operator-(const Ball& a)
{
    return {-a.middle, a.radius};
}
Ball operator+(const Ball& a, const Ball& b)
{
    return rounded(a.middle + b.middle, a.radius + b.radius);
}
Ball operator-(const Ball& a, const Ball& b)
{
    const Quad difference = a.middle - b.middle;
    return rounded(difference, a.radius + b.radius);
}
Quad reach_of_product(const Ball& a, const Ball& b)
{
    return fabs(a.middle) * b.radius + fabs(b.middle) * a.radius + a.radius * b.radius;
}
Ball operator*(const Ball& a, const Ball& b)
{
    return rounded(a.middle * b.middle, reach_of_product(a, b));
}
Ball operator/(const Ball& a, const Ball& b)
{
    const Quad quotient = a.middle / b.middle, divisor = fabs(b.middle);
    if (!(b.radius < divisor)) return {quotient, infinite()};
    if (a.radius == 0 && b.radius == 0) return rounded(quotient, 0);
    return rounded(quotient, (a.radius * divisor + fabs(a.middle) * b.radius) / (divisor * (divisor - b.radius)));
}

bool operator<(const Ball& a, const Ball& b)
{
    decide(are_apart(a, b));
    return a.middle < b.middle;
}
bool operator<=(const Ball& a, const Ball& b)
{
    decide(are_apart(a, b));
    return a.middle <= b.middle;
}
bool operator>(const Ball& a, const Ball& b)
{
    return b < a;
}
bool operator>=(const Ball& a, const Ball& b)
{
    return b <= a;
}
bool operator==(const Ball& a, const Ball& b)
{
    decide(are_apart(a, b));
    return a.middle == b.middle;
}

Ball fabs(const Ball& a)
{
    decide(are_apart(a, Ball(0)));
    return {Quad(fabs(a.middle)), a.radius};
}
Ball floor(const Ball& a)
{
    return of_steps(a, [](const Quad& x) { return Quad(floor(x)); });
}
Ball ceil(const Ball& a)
{
    return of_steps(a, [](const Quad& x) { return Quad(ceil(x)); });
}
Ball trunc(const Ball& a)
{
    return of_steps(a, [](const Quad& x) { return Quad(trunc(x)); });
}
Ball sqrt(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(sqrt(x)); }, one_rounding);
}
Ball sin(const Ball& a)
{
    return of_wave(a, sin(a.middle), cos(a.middle));
}
Ball cos(const Ball& a)
{
    return of_wave(a, cos(a.middle), sin(a.middle));
}
Ball tan(const Ball& a)
{
    const bool is_branch = a.radius < 1 && Quad(cos(low(a))) * Quad(cos(high(a))) > 0;
    if (!is_branch) return {Quad(tan(a.middle)), infinite()};
    return by_ends(a, [](const Quad& x) { return Quad(tan(x)); }, library);
}
Ball asin(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(asin(x)); }, library);
}
Ball acos(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(acos(x)); }, library);
}
Ball atan(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(atan(x)); }, library);
}
Ball sinh(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(sinh(x)); }, library);
}
Ball cosh(const Ball& a) // convex and even: furthest at an end even where 0 lies between
{
    return by_ends(a, [](const Quad& x) { return Quad(cosh(x)); }, library);
}
Ball tanh(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(tanh(x)); }, library);
}
Ball asinh(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(asinh(x)); }, library);
}
Ball acosh(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(acosh(x)); }, library);
}
Ball atanh(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(atanh(x)); }, library);
}
Ball exp(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(exp(x)); }, library);
}
Ball exp2(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(exp2(x)); }, library);
}
Ball log(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(log(x)); }, library);
}
Ball log2(const Ball& a)
{
    return by_ends(a, [](const Quad& x) { return Quad(log2(x)); }, library);
}

// Monotone along each axis for a positive base: furthest at a corner. Around a base of 0 only for a whole exponent.
Ball pow(const Ball& a, const Ball& b)
{
    const auto power = [](const Quad& x, const Quad& y) { return Quad(pow(x, y)); };
    const Quad middle = power(a.middle, b.middle);
    if (a.radius == 0 && b.radius == 0) return rounded(middle, 0, library);
    Quad reach = furthest(middle, power(low(a), low(b)), power(low(a), high(b)), power(high(a), low(b)),
                          power(high(a), high(b)));
    if (!(low(a) > 0)) {
        const bool is_whole = b.radius == 0 && Quad(floor(b.middle)) == b.middle;
        const bool holds_zero = !(high(a) < 0);
        if (!is_whole) return {middle, infinite()};
        if (holds_zero) reach = std::max(reach, furthest(middle, power(Quad(0), b.middle)));
        if (holds_zero && b.middle < 0) reach = infinite();
    }
    return rounded(middle, reach, library);
}

// The gradient of the angle is one over the distance. Around the origin, or across the cut, it is anything.
Ball atan2(const Ball& y, const Ball& x)
{
    const auto from_zero = [](const Ball& a) {
        const Quad distance = fabs(a.middle) - a.radius;
        return distance > 0 ? distance : Quad(0);
    };
    const Quad nearest = hypot(from_zero(x), from_zero(y)), middle = atan2(y.middle, x.middle);
    const bool crosses = low(x) < 0 && from_zero(y) == 0 && y.radius != 0;
    Quad reach = 7; // more than a turn
    if (nearest > 0 && !crosses) reach = Quad(hypot(x.radius, y.radius)) / nearest;
    if (x.radius == 0 && y.radius == 0) reach = 0;
    return rounded(middle, reach <= 7 ? reach : Quad(7), library);
}

bool signbit(const Ball& a)
{
    return signbit(a.middle);
}

// Reached only through what semantics.h builds; `a` is of either sign.
Ball copysign(const Ball& a, const Ball& sign)
{
    const bool is_certain = are_apart(sign, Ball(0));
    decide(is_certain);
    return {Quad(copysign(a.middle, sign.middle)), is_certain ? a.radius : Quad(a.radius + 2 * fabs(a.middle))};
}

} // namespace haptel::test

// What double does at once, and would seem worse if it were put together from balls.
namespace haptel::ir::exact {

template <>
test::Ball atan2(const test::Ball& y, const test::Ball& x)
{
    const bool is_origin = y.middle == 0 && x.middle == 0;
    const bool is_exact = y.radius == 0 && x.radius == 0;
    return is_origin ? test::Ball(0, is_exact ? 0 : 7) : test::atan2(y, x);
}

} // namespace haptel::ir::exact

namespace haptel::ir::semantics {

using test::Ball, test::are_apart, test::rounded;

template <>
bool is_nan(const Ball& a)
{
    return is_nan(a.middle);
}

template <>
bool is_finite(const Ball& a)
{
    test::decide(is_finite(a.radius));
    return is_finite(a.middle);
}

template <>
Ball minimum(const Ball& a, const Ball& b)
{
    test::decide(are_apart(a, b));
    const Quad middle = minimum(a.middle, b.middle);
    if (are_apart(a, b)) return {middle, a.middle < b.middle ? a.radius : b.radius};
    return {middle, std::max(a.radius, b.radius)};
}

template <>
Ball maximum(const Ball& a, const Ball& b)
{
    return -minimum(Ball(-a), Ball(-b));
}

template <>
Ball round_to_even(const Ball& a)
{
    return test::of_steps(a, [](const Quad& x) { return round_to_even(x); });
}

template <>
Ball fused_multiply_add(const Ball& a, const Ball& b, const Ball& c)
{
    return rounded(a.middle * b.middle + c.middle, test::reach_of_product(a, b) + c.radius);
}

// Its gradient has length 1. Rounded are squares, sums and root: no more than 4 half ulps for four of them.
template <>
Ball length(const Ball* x, int count)
{
    Quad middles[4], squares = 0;
    for (int i = 0; i < count; ++i) {
        middles[i] = x[i].middle;
        squares += x[i].radius * x[i].radius;
    }
    return rounded(length(middles, count), sqrt(squares), 4);
}

// Beside the sine's own rounding: of 2 pi, and of the product with it.
template <>
Ball sine_of_turns(const Ball& a)
{
    const Quad reach = two_pi<Quad>() * a.radius;
    return rounded(sine_of_turns(a.middle), reach <= 2 ? reach : Quad(2), test::library + 3);
}

template <>
Ball cosine_of_turns(const Ball& a)
{
    const Quad reach = two_pi<Quad>() * a.radius;
    return rounded(cosine_of_turns(a.middle), reach <= 2 ? reach : Quad(2), test::library + 3);
}

template <>
uint32_t to_i32(const Ball& a)
{
    test::decide(to_i32(test::low(a)) == to_i32(test::high(a)));
    return to_i32(a.middle);
}

template <>
uint32_t to_u32(const Ball& a)
{
    test::decide(to_u32(test::low(a)) == to_u32(test::high(a)));
    return to_u32(a.middle);
}

} // namespace haptel::ir::semantics

namespace haptel::ir {

template class Interpreter<test::Ball>;

} // namespace haptel::ir
