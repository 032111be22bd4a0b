// pow: 2^(y log2 |x|) with the logarithm to 65 bits, since y may make its rounding a thousand times larger.
#pragma once

#include "lang/ir/elementary_exponential.h"
#include "lang/ir/elementary_logarithm.h"

namespace haptel::ir::elementary {

// log2 of x > 0, in halves. In f32 one number is enough: it is computed in f64.
template <typename R>
Pair<R> log2_in_halves(R x)
{
    using C = Constants<double>;
    const Split<R> split(x);
    const R m = split.mantissa, f = m - 1;
    // s = f / (1 + m), the divisor exact as a sum, the quotient's high part short enough for an exact remainder
    const R d = m + 1, d_low = m - (d - 1), d_high = without_low_half(d), inverse = 1 / d;
    const R s_high = without_low_half(f * inverse);
    const R s_low = (((f - s_high * d_high) - s_high * (d - d_high)) - s_high * d_low) * inverse;
    const R s = s_high + s_low;
    // t = 3 + z + z^2 T(z)
    const R z_high = s_high * s_high, z_low = s_low * (s_high + s), z = z_high + z_low;
    const Pair<R> sum = exact_sum_of_ordered(constant(x, 3), z_high);
    const Pair<R> t = halves(Pair<R>{sum.high, sum.low + (z_low + z * z * polynomial(C::logarithm_tail, z))});
    // 2 / (3 ln 2) s t + exponent
    const Pair<R> product = halves(Pair<R>{s_high * t.high, s_low * t.high + s * t.low});
    const Pair<R> total = exact_sum_of_ordered(split.exponent, product.high * C::tail_scale[0]);
    const R low = product.low * C::tail_scale[0] + (product.high + product.low) * C::tail_scale[1];
    return halves(Pair<R>{total.high, total.low + low});
}

// 2^(y log2 x) for x > 0 and finite, |y| <= 2^100.
template <typename R>
R power_of_positive(R x, R y)
{
    const R y_high = without_low_half(y), y_low = y - y_high;
    const Pair<R> logarithm = log2_in_halves(x);
    const R high = y_high * logarithm.high, low = y_low * logarithm.high + y * logarithm.low;
    const R bounded = clamped(high, -1100, 1100);
    const R bounded_low = select(high == bounded, low, constant(x, 0));
    const R k = nearest_whole(bounded + bounded_low);
    return scaled(exp_near_zero(times_ln2(halves(Pair<R>{bounded - k, bounded_low}))), k);
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

template <typename R>
auto is_whole(R size)
{
    constexpr double whole = 0x1p52; // from here on every number is
    return select(size < whole, (size + whole) - whole, size) == size;
}

// C99: of |x| at the edges, then the sign, then NaN, and 1 wherever x = 1 or y = 0.
template <typename R>
R with_edges_of_power(R x, R y, R positive)
{
    const R one = constant(x, 1), nought = constant(x, 0), endless = constant(x, infinity), size = abs(x),
            reach = abs(y);
    const R of_zero = select(y < 0, endless, nought), of_infinity = select(y < 0, nought, endless);
    const R edged = select(size == nought, of_zero, select(size == endless, of_infinity, positive));
    const auto y_is_whole = is_whole(reach), y_is_even = is_whole(reach * 0.5);
    const R with_sign = select(y_is_even, edged, flipped(edged, x));
    const R of_negative = select(y_is_whole, with_sign, select(size == endless, edged, constant(x, not_a_number)));
    const R chosen = select(x < 0, of_negative, select(y_is_whole, with_sign, edged));
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
