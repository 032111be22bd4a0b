#include "tests/support/ball.h"

#include "tests/support/ball_arithmetic.h"

#include <algorithm>

namespace haptel::test {

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
