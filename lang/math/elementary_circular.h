// sin, cos and tan of radians: the angle as a number of quarter turns and a rest, and a polynomial of the rest.
//
// In f32 the angle is reduced in f64 (it may be one: in mixed precision), and polynomials are of f32.
#pragma once

#include "lang/math/elementary_constants.h"
#include "lang/math/elementary_pair.h"

namespace haptel::ir::elementary {

inline constexpr double huge_angle = 0x1p20; // up to here a whole number of quarter turns times 33 bits is exact

// Of an angle in f64, not negative. Rounding of `low`, relative to the angle's rest, is 2^-53: no double is nearer to a
// quarter turn than 2^-62.
template <typename R>
Angle<R> reduced(R x)
{
    constexpr auto& quarter = Constants<double>::quarter_turn;
    constexpr double rounder = Format<double>::rounder;
    const R k = (x * two_over_pi + rounder) - rounder;
    const Pair<R> second = exact_sum(x - k * quarter[0], -(k * quarter[1]));
    const Pair<R> third = exact_sum(second.high, -(k * quarter[2]));
    const Pair<R> rest = exact_sum_of_ordered(third.high, (second.low + third.low) - k * quarter[3]);
    Angle<R> angle{k, rest.high, rest.low};
    reduce_where(x > huge_angle, x, angle);
    return angle;
}

// Sine and cosine of the rest, sums of a number and a smaller one, and the quarter in the low bits of a word.
template <typename R>
struct Circle {
    using Layout = Format<typename R::Float>;
    using Bits = typename Layout::Bits;
    Pair<R> sine, cosine;
    R quarter;

    explicit Circle(const Angle<R>& angle)
        : sine{angle.high, angle.high}, cosine(sine), quarter(angle.quarters + Layout::rounder)
    {
        using C = Constants<typename R::Float>;
        const R r = angle.high, u = r * r, half = 0.5 * u;
        sine.low = r * u * polynomial(C::sine, u) + (angle.low - half * angle.low);
        cosine.high = 1 - half;
        cosine.low = ((1 - cosine.high) - half) + (u * u * polynomial(C::cosine, u) - r * angle.low);
    }
    auto is_odd() const { return is_set(bits(quarter) & Bits{1}); }
    // A number whose sign bit is bit `from` of the quarter.
    R sign(int from, Bits added = 0) const
    {
        return with_bits(quarter, (bits(quarter) + added) << (Layout::width - 1 - from));
    }
};

// In f32, of an angle in f64; `low` is what high has no room for.
template <typename R>
auto single_circle_of(R angle)
{
    const R x = abs(angle);
    constexpr auto& quarter = Constants<double>::quarter_turn;
    constexpr double rounder = Format<double>::rounder;
    const R k = (x * two_over_pi + rounder) - rounder;
    const R rest = ((x - k * quarter[0]) - k * quarter[1]) - k * quarter[2];
    Angle<R> turned{k, rest, rest};
    reduce_where(x > huge_angle, x, turned);
    const auto quarters = narrow(turned.quarters), high = narrow(turned.high);
    return Circle(Angle{quarters, high, narrow(turned.high - widen(high))});
}

// In the precision of the angle.
template <typename R>
Circle<R> circle_of(R angle)
{
    if constexpr (R::is_single)
        return single_circle_of(widen(angle));
    else
        return Circle<R>(reduced(abs(angle)));
}

// `of`: the angle, in the same precision.
template <typename R>
R sin(const Circle<R>& circle, R of)
{
    const Pair<R> size = select(circle.is_odd(), circle.cosine, circle.sine);
    return flipped(flipped(size.high + size.low, circle.sign(1)), of);
}

template <typename R>
R cos(const Circle<R>& circle, R)
{
    const Pair<R> size = select(circle.is_odd(), circle.sine, circle.cosine);
    return flipped(size.high + size.low, circle.sign(1, 1));
}

template <typename R>
R tan(const Circle<R>& circle, R of)
{
    const R size = quotient(select(circle.is_odd(), circle.cosine, circle.sine),
                            select(circle.is_odd(), circle.sine, circle.cosine));
    return flipped(flipped(size, circle.sign(0)), of);
}

} // namespace haptel::ir::elementary
