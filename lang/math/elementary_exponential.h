// exp and exp2. x = k ln 2 + r with a whole k, and e^r by the even and the odd part of its series.
#pragma once

#include "lang/math/elementary_constants.h"
#include "lang/math/elementary_pair.h"

namespace haptel::ir::elementary {

template <typename R>
R nearest_whole(R a)
{
    constexpr double rounder = Format<typename R::Float>::rounder;
    return (a + rounder) - rounder;
}

// a where it lies in the range, the nearer end elsewhere; NaN stays.
template <typename R>
R clamped(R a, double minimum, double maximum)
{
    return select(a < minimum, constant(a, minimum), select(a > maximum, constant(a, maximum), a));
}

// 2^k for a whole k within the exponents of normal numbers.
template <typename R>
R power_of_two(R k)
{
    using Layout = Format<typename R::Float>;
    const R shifted = k + Layout::rounder;
    return with_bits(k, (bits(shifted) << Layout::digits) + (typename Layout::Bits{Layout::bias} << Layout::digits));
}

// a 2^k, rounded once, also where it overflows or is subnormal.
template <typename R>
R scaled(R a, R k)
{
    const R half = nearest_whole(k * 0.5);
    return (a * power_of_two(half)) * power_of_two(k - half);
}

// e^(r.high + r.low) for |r| <= ln(2) / 2.
template <typename R>
R exp_near_zero(const Pair<R>& r)
{
    using C = Constants<typename R::Float>;
    const R u = r.high * r.high;
    const Pair<R> linear = exact_sum_of_ordered(constant(u, 1), r.high);
    const Pair<R> quadratic = exact_sum_of_ordered(linear.high, 0.5 * u);
    const R odd = r.high * u * polynomial(C::odd, u), even = u * u * polynomial(C::even, u);
    return quadratic.high + ((linear.low + quadratic.low) + (linear.high * r.low + odd + even));
}

// ln 2 times a number of |a| <= 1 / 2, given in halves.
template <typename R>
Pair<R> times_ln2(const Pair<R>& part)
{
    using C = Constants<typename R::Float>;
    const R high = part.high * C::ln2_halves[0];
    return exact_sum_of_ordered(high, part.low * C::ln2_halves[0] + (part.high + part.low) * C::ln2_halves[1]);
}

template <typename R>
R exp(R a)
{
    using C = Constants<typename R::Float>;
    const R x = clamped(a, C::exp_range[0], C::exp_range[1]);
    const R k = nearest_whole(x * log2e);
    const R high = x - k * C::ln2[0];
    return scaled(exp_near_zero(exact_sum_of_ordered(high, -(k * C::ln2[1]))), k);
}

template <typename R>
R exp2(R a)
{
    using C = Constants<typename R::Float>;
    const R x = clamped(a, C::exp2_range[0], C::exp2_range[1]);
    const R k = nearest_whole(x);
    const R rest = x - k, upper = without_low_half(rest);
    return scaled(exp_near_zero(times_ln2(Pair<R>{upper, rest - upper})), k);
}

} // namespace haptel::ir::elementary
