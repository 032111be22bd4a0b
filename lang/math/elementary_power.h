// pow: e^(y ln |x|) with the logarithm to 65 bits, since y may make its rounding a thousand times larger.
#pragma once

#include "lang/math/elementary_exponential.h"
#include "lang/math/elementary_logarithm.h"

namespace haptel::ir::elementary {

// ln x for x > 0, as a number of no more than 26 bits and a rest. What the rest is made of may come late: nothing of
// the first waits for it.
template <typename R>
Pair<R> logarithm_in_halves(R x)
{
    using C = Constants<double>;
    const Split<R> split(x);
    const R m = split.mantissa, f = m - 1;
    // q = 2 / 3 s with s = f / (1 + m): the divisor exact as a sum, the quotient's high part of 24 bits, so that the
    // remainder and s^2 are exact
    const R d = m + 1, d_low = m - (d - 1), d_high = without_low_half(d), third = 1 / (3 * d);
    const R rounded = 2 * f * third, q_high = with_bits(x, bits(rounded) & ~uint64_t{0x1fffffff}), thrice = 3 * q_high;
    const R q_low = ((2 * f - thrice * d_high) - (thrice * (d - d_high) + thrice * d_low)) * third;
    const R q = q_high + q_low;
    // ln m = q t with t = 3 + z + 3 / 5 z^2 + z^3 T(z), z = s^2: the polynomial need not wait for q_low
    const R square = 2.25 * (rounded * rounded), cubic = polynomial(C::logarithm_tail, square);
    const R z_high = 2.25 * (q_high * q_high), z_low = 2.25 * (q_low * (q_high + q)), z = z_high + z_low;
    const R z_upper = without_low_half(z_high), z_rest = (z_high - z_upper) + z_low, exact = z_upper * z_upper;
    const R tail = 0.6 * exact + (0.6 * (z_rest * (z_upper + z)) + z * z * z * cubic);
    const R most = square * square * (0.6 + 3.0 / 7 * square); // of the tail, early
    const R t_high = without_low_half(3 + (z_high + most)), t_low = (z_high - (t_high - 3)) + (z_low + tail);
    const Pair<R> sum = exact_sum_of_ordered(split.exponent * C::ln2[0], q_high * t_high);
    const R upper = without_low_half(sum.high), low = split.exponent * C::ln2[1] + q_low * t_high + q * t_low;
    return {upper, (sum.high - upper) + (sum.low + low)};
}

// e^(y ln x) for x > 0 and finite, |y| <= 2^100.
template <typename R>
R power_of_positive(R x, R y)
{
    using C = Constants<double>;
    const R y_high = without_low_half(y), y_low = y - y_high;
    const Pair<R> logarithm = logarithm_in_halves(x);
    const R high = y_high * logarithm.high, low = y_low * logarithm.high + y * logarithm.low;
    const R bounded = clamped(high, -760, 760);
    const R bounded_low = select(high == bounded, low, constant(x, 0));
    const R k = nearest_whole((bounded + bounded_low) * log2e);
    return scaled(exp_near_zero(exact_sum_of_ordered(bounded - k * C::ln2[0], bounded_low - k * C::ln2[1])), k);
}

// The same for numbers that were f32, to a precision that leaves the rounding to f32.
template <typename R>
R short_power_of_positive(R x, R y)
{
    using C = Constants<float>;
    const Split<R> split(x);
    const R f = split.mantissa - 1, s = f / (f + 2), z = s * s;
    const R logarithm = split.exponent + (2 * s + s * z * polynomial(C::logarithm_f64, z)) * log2e;
    const R e = clamped(y * logarithm, -300, 300);
    const R k = nearest_whole(e);
    const R r = (e - k) * std::numbers::ln2, u = r * r;
    const R near = 1 + (r + (r * u * polynomial(C::odd_f64, u) + u * polynomial(C::even_f64, u)));
    return near * power_of_two(k);
}

// The way of y to the nearest even number, of either sign: 0, or 1 for an odd one. From 2^53 on all are even.
template <typename R>
R way_to_even(R y)
{
    constexpr double even = 0x1p53;
    const R reach = select(abs(y) < even, abs(y), constant(y, even));
    return reach - ((reach + even) - even);
}

// C99: of |x| at the edges, then the sign, then NaN, and 1 wherever x = 1 or y = 0.
template <typename R>
R with_edges_of_power(R x, R y, R positive)
{
    const R one = constant(x, 1), nought = constant(x, 0), endless = constant(x, infinity), size = abs(x);
    const R of_zero = select(y < 0, endless, nought), of_infinity = select(y < 0, nought, endless);
    const R edged = select(size == nought, of_zero, select(size == endless, of_infinity, positive));
    const R rest = way_to_even(y), undefined = select(size == endless, edged, constant(x, not_a_number));
    const R of_broken = select(x < 0, undefined, edged), of_even = select(rest == nought, edged, of_broken);
    const R chosen = select(abs(rest) == one, flipped(edged, x), of_even);
    const R sum = x + y;
    const R known = select(x == x, select(y == y, chosen, sum), sum);
    return select(x == one, one, select(y == nought, one, known));
}

template <typename R>
R pow(R x, R y)
{
    constexpr double enough = 0x1p100; // no product overflows, and no result is another
    if constexpr (R::is_single) {
        const auto a = widen(x), b = widen(y);
        return narrow(with_edges_of_power(a, b, short_power_of_positive(abs(a), clamped(b, -enough, enough))));
    } else {
        return with_edges_of_power(x, y, power_of_positive(abs(x), clamped(y, -enough, enough)));
    }
}

} // namespace haptel::ir::elementary
