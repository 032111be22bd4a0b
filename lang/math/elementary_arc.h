// atan, atan2, atan2pi, asin, acos: a constant in two parts, and a polynomial of what is left.
#pragma once

#include "lang/math/elementary_constants.h"
#include "lang/math/elementary_logarithm.h"
#include "lang/math/elementary_pair.h"

namespace haptel::ir::elementary {

template <typename R, size_t count>
Pair<R> pair_of(R like, const double (&parts)[count])
{
    return {constant(like, parts[0]), constant(like, parts[1])};
}

// start + sign (of + rest), where |start.high| >= |of| or start is 0.
template <typename R>
R assembled(const Pair<R>& start, R sign, R of, R rest)
{
    const Pair<R> sum = exact_sum_of_ordered(start.high, sign * of);
    return sum.high + (sum.low + (start.low + sign * rest));
}

// Angles that a direction begins from, in two parts, and the small angle t + rest of radians that is added to one.
template <typename R>
struct InRadians {
    using C = Constants<typename R::Float>;
    static constexpr const double (&half_turn)[2] = C::pi, (&quarter_turn)[2] = C::half_pi,
                                  (&eighth_turn)[2] = C::quarter_pi, (&of_half)[2] = C::atan_of_half;
    static R sum(R t, R rest) { return t + rest; }
};

template <typename R>
struct InHalfTurns {
    using C = Constants<typename R::Float>;
    static constexpr double half_turn[] = {1, 0}, quarter_turn[] = {0.5, 0}, eighth_turn[] = {0.25, 0};
    static constexpr const double (&of_half)[2] = C::half_turns_of_half;
    static R sum(R t, R rest)
    {
        const R upper = without_low_half(t);
        return upper * C::inverse_pi[0] +
               ((t - upper) * C::inverse_pi[0] + (t * C::inverse_pi[1] + rest * (C::inverse_pi[0] + C::inverse_pi[1])));
    }
};

// start + sign atan(n / d) for 0 <= n <= d, both far from overflow. Of the quotient what is nearest of 0, 1 / 2 and 1
// is taken away: tan(a - b) = (tan a - tan b) / (1 + tan a tan b).
template <typename Unit, typename R>
R turned(const Pair<R>& start, R sign, R n, R d)
{
    const auto is_mid = n > 0.4375 * d, is_high = n > 0.6875 * d;
    const Pair<R> zero{constant(n, 0), constant(n, 0)};
    const Pair<R> base =
        select(is_high, pair_of(n, Unit::eighth_turn), select(is_mid, pair_of(n, Unit::of_half), zero));
    const R c = select(is_high, constant(n, 1), select(is_mid, constant(n, 0.5), zero.high));
    const R t = (n - c * d) / (d + c * n), u = t * t;
    const R rest = t * u * polynomial(Constants<typename R::Float>::arc_tangent, u);
    return assembled(start, sign, base.high, base.low + Unit::sum(t, rest));
}

template <typename R>
R atan(R a)
{
    using C = Constants<typename R::Float>;
    constexpr double flat = R::is_single ? 0x1p30 : 0x1p60; // from here on it is a quarter turn
    const R one = constant(a, 1), nought = constant(a, 0), size = select(abs(a) > flat, constant(a, flat), abs(a));
    const auto is_steep = size > one;
    const Pair<R> start = select(is_steep, pair_of(a, C::half_pi), Pair<R>{nought, nought});
    const R n = select(is_steep, one, size), d = select(is_steep, size, one);
    return flipped(turned<InRadians<R>>(start, select(is_steep, -one, one), n, d), a);
}

// The direction of (x, y), at the origin 0, whatever the signs of zeros.
template <typename Unit, typename R>
R direction(R y, R x)
{
    constexpr double large = R::is_single ? 0x1p100 : 0x1p900, factor = R::is_single ? 0x1p-40 : 0x1p-300;
    const R one = constant(x, 1), nought = constant(x, 0), width = abs(x), height = abs(y);
    const auto is_steep = height > width, is_behind = x < nought;
    const Pair<R> start = select(is_steep, pair_of(x, Unit::quarter_turn),
                                 select(is_behind, pair_of(x, Unit::half_turn), Pair<R>{nought, nought}));
    const R sign = select(is_behind, select(is_steep, one, -one), select(is_steep, -one, one));
    // away from overflow and from subnormal numbers; of infinities, their direction
    R n = select(is_steep, width, height), d = select(is_steep, height, width);
    const auto is_endless = d == constant(x, infinity);
    n = select(is_endless, select(n == d, one, nought), n);
    d = select(is_endless, one, d);
    const R scale = select(d > large, constant(x, factor), select(d < 1 / large, constant(x, 1 / factor), one));
    const R angle = flipped(turned<Unit>(start, sign, n * scale, d * scale), y);
    const R sum = x + y, known = select(x == x, select(y == y, angle, sum), sum);
    return select(height == nought, select(width == nought, nought, known), known);
}

template <typename R>
R atan2(R y, R x)
{
    return direction<InRadians<R>>(y, x);
}

template <typename R>
R atan2pi(R y, R x)
{
    return direction<InHalfTurns<R>>(y, x);
}

// For asin and acos: of |a| <= 1/2 the sine itself, else that of half the angle's complement, u = (1 - |a|) / 2.
template <typename R>
struct ArcSine {
    using Truth = decltype(std::declval<R>() < std::declval<R>());
    Truth is_high;
    R base, rest; // asin |a|, or 2 asin sqrt(u), as a sum

    explicit ArcSine(R size) : is_high(size > constant(size, 0.5)), base(size), rest(size)
    {
        const R u = select(is_high, (1 - size) * 0.5, size * size), s = sqrt(u), upper = without_low_half(s);
        const R lower = (u - upper * upper) / (s + upper + 0x1p-60); // the term is for u = 0 alone
        const R cubic = u * polynomial(Constants<typename R::Float>::arc_sine, u);
        base = select(is_high, 2 * upper, size);
        rest = select(is_high, 2 * (lower + s * cubic), size * cubic);
    }
};

template <typename R>
R asin(R a)
{
    const R one = constant(a, 1), nought = constant(a, 0);
    const ArcSine<R> arc(abs(a));
    const Pair<R> start =
        select(arc.is_high, pair_of(a, Constants<typename R::Float>::half_pi), Pair<R>{nought, nought});
    return flipped(assembled(start, select(arc.is_high, -one, one), arc.base, arc.rest), a);
}

template <typename R>
R acos(R a)
{
    using C = Constants<typename R::Float>;
    const R one = constant(a, 1), nought = constant(a, 0);
    const ArcSine<R> arc(abs(a));
    const auto is_negative = a < nought;
    const Pair<R> far = select(is_negative, pair_of(a, C::pi), Pair<R>{nought, nought});
    const R toward = select(is_negative, one, -one);
    return assembled(select(arc.is_high, far, pair_of(a, C::half_pi)), select(arc.is_high, -toward, toward), arc.base,
                     arc.rest);
}

} // namespace haptel::ir::elementary
