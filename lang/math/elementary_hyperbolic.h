// sinh, cosh, tanh by the even and the odd part of e^r, and their inverses by a logarithm of 1 + v with v in two parts.
#pragma once

#include "lang/math/elementary_exponential.h"
#include "lang/math/elementary_logarithm.h"

namespace haptel::ir::elementary {

// A quarter of sinh x and of cosh x, for 0 <= x <= sinh_limit: with x = k ln 2 + r, a = 2^(k - 1) and b = 2^(-k - 1),
// sinh x = (a - b) cosh r + (a + b) sinh r, in which multiplying by a or b is exact.
template <typename R>
struct Hyperbola {
    Pair<R> sine, cosine;

    explicit Hyperbola(R x) : sine{x, x}, cosine{x, x}
    {
        using C = Constants<typename R::Float>;
        const R k = nearest_whole(x * log2e);
        const R high = x - k * C::ln2[0];
        const Pair<R> r = exact_sum_of_ordered(high, -(k * C::ln2[1]));
        const R u = r.high * r.high;
        const R odd = r.low + r.high * u * polynomial(C::odd, u),
                even = u * u * polynomial(C::even, u) + (0.5 * u + r.high * r.low);
        const R a = power_of_two(k - 3), b = power_of_two(-3 - select(k > 60, constant(k, 60), k));
        const Pair<R> difference = exact_sum_of_ordered(a, -b), sum = exact_sum_of_ordered(a, b);
        const Pair<R> linear_sine = exact_sum_of_ordered(a * r.high, b * r.high),
                      linear_cosine = exact_sum_of_ordered(a * r.high, -(b * r.high));
        const Pair<R> all_sine = exact_sum(difference.high, linear_sine.high),
                      all_cosine = exact_sum_of_ordered(sum.high, linear_cosine.high);
        sine = {all_sine.high,
                all_sine.low + (difference.low + linear_sine.low + (difference.high * even + sum.high * odd))};
        cosine = {all_cosine.high,
                  all_cosine.low + (sum.low + linear_cosine.low + (sum.high * even + difference.high * odd))};
    }
};

template <typename R>
R sinh(R a)
{
    using C = Constants<typename R::Float>;
    const R size = abs(a);
    const Pair<R> sine = Hyperbola<R>(clamped(size, 0, C::sinh_limit)).sine;
    return flipped(select(size < C::identity_below, size, 4 * (sine.high + sine.low)), a);
}

template <typename R>
R cosh(R a)
{
    const Pair<R> cosine = Hyperbola<R>(clamped(abs(a), 0, Constants<typename R::Float>::sinh_limit)).cosine;
    return 4 * (cosine.high + cosine.low);
}

template <typename R>
R tanh(R a)
{
    using C = Constants<typename R::Float>;
    const R size = abs(a);
    const Hyperbola<R> both(clamped(size, 0, C::tanh_limit));
    const R result = quotient(both.sine, both.cosine);
    return flipped(select(size < C::identity_below, size, clamped(result, 0, 1)), a);
}

// ln(1 + v) for v >= 0, and ln 2 + ln x in its place from x = 2^60 on.
template <typename R>
R logarithm_beyond_one(const Pair<R>& v, R x)
{
    const R one = constant(x, 1), nought = constant(x, 0);
    const auto is_large = x > 0x1p60;
    const Pair<R> sum = exact_sum(one, v.high);
    const R offset = select(is_large, nought, (sum.low + v.low) / sum.high);
    const Split<R> split(select(is_large, x, sum.high));
    const R exponent = split.exponent + select(is_large, one, nought);
    return natural_logarithm(exponent, split.mantissa, exponent * Constants<typename R::Float>::ln2[1] + offset);
}

// ln(x + sqrt(x^2 + 1)) as ln(1 + x + x^2 / (1 + sqrt(x^2 + 1)))
template <typename R>
R asinh(R a)
{
    const R x = abs(a), square = x * x;
    const Pair<R> v = exact_sum(x, square / (1 + sqrt(square + 1)));
    return flipped(select(x < infinity, logarithm_beyond_one(v, x), x), a);
}

// ln(x + sqrt(x^2 - 1)) as ln(1 + t + sqrt(t (t + 2))) with t = x - 1
template <typename R>
R acosh(R x)
{
    const R t = x - 1;
    const R result = logarithm_beyond_one(exact_sum(t, sqrt(t * (t + 2))), x);
    return select(x < 1, constant(x, not_a_number), select(x < infinity, result, x));
}

// ln((1 + x) / (1 - x)) / 2 as ln(1 + 2 x + 2 x^2 / (1 - x)) / 2
template <typename R>
R atanh(R a)
{
    const R x = abs(a), twice = x + x;
    const R half = 0.5 * logarithm_beyond_one(exact_sum(twice, twice * x / (1 - x)), x);
    const R at_end = select(x == constant(x, 1), constant(x, infinity), constant(x, not_a_number));
    return flipped(select(x < 1, half, at_end), a);
}

} // namespace haptel::ir::elementary
