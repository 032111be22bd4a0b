// log and log2. x = 2^k m with sqrt(1/2) <= m < sqrt(2), f = m - 1 exactly, and the series of ln((1 + s) / (1 - s)) at
// s = f / (2 + f). What is subtracted from f at the end is small beside it, so that only the last sum counts.
#pragma once

#include "lang/math/elementary_constants.h"
#include "lang/math/elementary_pair.h"

#include <limits>
#include <numbers>

namespace haptel::ir::elementary {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// x = 2^exponent mantissa, for a positive finite x; anything else for others.
template <typename R>
struct Split {
    R exponent, mantissa;

    explicit Split(R x) : exponent(x), mantissa(x)
    {
        const auto is_subnormal = x < Layout::smallest_normal;
        const auto word = bits(select(is_subnormal, x * 0x1p64, x)) + (one - sqrt_half);
        const R biased = with_bits(x, (word >> Layout::digits) | whole);
        exponent = biased - select(is_subnormal, constant(x, whole_number + Layout::bias + shift),
                                   constant(x, whole_number + Layout::bias));
        mantissa = with_bits(x, (word & fraction) + sqrt_half);
    }

private:
    using Layout = Format<typename R::Float>;
    using Bits = typename Layout::Bits;
    static constexpr Bits one = Bits{Layout::bias} << Layout::digits, fraction = (Bits{1} << Layout::digits) - 1,
                          sqrt_half =
                              std::bit_cast<Bits>(static_cast<typename R::Float>(1 / std::numbers::sqrt2_v<double>)),
                          whole = Bits{Layout::bias + Layout::digits} << Layout::digits;
    static constexpr double shift = 64, whole_number = std::bit_cast<typename R::Float>(whole);
};

// What a logarithm is where its argument is not a positive finite number.
template <typename R>
R with_edges_of_logarithm(R x, R result)
{
    const R at_end = select(x < infinity, result, x);
    return select(x > 0, at_end, select(x == constant(x, 0), constant(x, -infinity), constant(x, not_a_number)));
}

// ln(1 + f) = f - (half_square - tail)
template <typename R>
struct LogarithmTerms {
    R f, half_square, tail;

    explicit LogarithmTerms(R mantissa) : f(mantissa - 1), half_square(0.5 * f * f), tail(f)
    {
        const R s = f / (f + 2), z = s * s;
        tail = s * (half_square + z * polynomial(Constants<typename R::Float>::logarithm, z));
    }
};

// ln(2^exponent mantissa), and `rest`: the low part of exponent ln 2, and what else is as small.
template <typename R>
R natural_logarithm(R exponent, R mantissa, R rest)
{
    using C = Constants<typename R::Float>;
    const LogarithmTerms<R> terms(mantissa);
    const Pair<R> sum = exact_sum_of_ordered(exponent * C::ln2[0], terms.f);
    return sum.high + (sum.low + ((rest + terms.tail) - terms.half_square));
}

template <typename R>
R log(R x)
{
    const Split<R> split(x);
    const R low = split.exponent * Constants<typename R::Float>::ln2[1];
    return with_edges_of_logarithm(x, natural_logarithm(split.exponent, split.mantissa, low));
}

template <typename R>
R log2(R x)
{
    using C = Constants<typename R::Float>;
    const Split<R> split(x);
    const LogarithmTerms<R> terms(split.mantissa);
    const R high = without_low_half(terms.f - terms.half_square);
    const R low = ((terms.f - high) - terms.half_square) + terms.tail;
    const Pair<R> sum = exact_sum_of_ordered(split.exponent, high * C::log2e_halves[0]);
    const R rest = low * C::log2e_halves[0] + (low + high) * C::log2e_halves[1];
    return with_edges_of_logarithm(x, sum.high + (sum.low + rest));
}

} // namespace haptel::ir::elementary
