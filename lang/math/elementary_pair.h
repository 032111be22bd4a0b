// Polynomials, and sums and products whose rounding is kept: high + low, low no more than rounding of high.
#pragma once

#include "lang/math/elementary_number.h"

#include <cstddef>

namespace haptel::ir::elementary {

template <typename R>
struct Pair {
    R high, low;
};

template <typename R>
R without_low_half(R a)
{
    return with_bits(a, bits(a) & ~Format<typename R::Float>::low_half);
}

template <typename R>
Pair<R> exact_sum(R a, R b)
{
    const R sum = a + b, of_b = sum - a;
    return {sum, (a - (sum - of_b)) + (b - of_b)};
}

// For |a| >= |b|, or a = 0.
template <typename R>
Pair<R> exact_sum_of_ordered(R a, R b)
{
    const R sum = a + b;
    return {sum, (a - sum) + b};
}

template <typename Truth, typename R>
Pair<R> select(Truth condition, const Pair<R>& a, const Pair<R>& b)
{
    return {select(condition, a.high, b.high), select(condition, a.low, b.low)};
}

// Of sums of a number and a smaller one.
template <typename R>
R quotient(const Pair<R>& a, const Pair<R>& b)
{
    const Pair<R> above = exact_sum_of_ordered(a.high, a.low), below = exact_sum_of_ordered(b.high, b.low);
    const R rounded = above.high / below.high;
    return rounded + (above.low - rounded * below.low) / below.high;
}

// The halves of high + low: the upper as short as without_low_half makes it.
template <typename R>
Pair<R> halves(const Pair<R>& a)
{
    const R upper = without_low_half(a.high + a.low);
    return {upper, (a.high - upper) + a.low};
}

// a with the sign bit flipped where that of `sign` is set; and so for a word.
template <typename R>
R flipped(R a, R sign)
{
    using Layout = Format<typename R::Float>;
    return with_bits(a, bits(a) ^ (bits(sign) & (typename Layout::Bits{1} << (Layout::width - 1))));
}

// In pairs, pairs of pairs and so on: less rounding than Horner's rule, and a processor does halves at once.
template <size_t first, size_t count, typename R, size_t all>
R polynomial_part(const double (&coefficients)[all], const R (&powers)[5])
{
    static_assert(count >= 2 && count <= 32);
    constexpr size_t log_half = std::bit_width(count - 1) - 1, half = size_t{1} << log_half;
    const R& power = powers[log_half];
    if constexpr (count == 2)
        return power * coefficients[first + 1] + coefficients[first];
    else if constexpr (count == half + 1)
        return power * coefficients[first + half] + polynomial_part<first, half>(coefficients, powers);
    else
        return power * polynomial_part<first + half, count - half>(coefficients, powers) +
               polynomial_part<first, half>(coefficients, powers);
}

template <typename R, size_t count>
R polynomial(const double (&coefficients)[count], R x)
{
    constexpr size_t needed = std::bit_width(count - 1);
    const R second = needed > 1 ? x * x : x, fourth = needed > 2 ? second * second : x,
            eighth = needed > 3 ? fourth * fourth : x;
    return polynomial_part<0, count>(coefficients, {x, second, fourth, eighth, needed > 4 ? eighth * eighth : x});
}

} // namespace haptel::ir::elementary
