// Intervals of the functions whose row in ops.def tells their shape: where they rise, fall, turn round and repeat.
#pragma once

#include "lang/ir/bounds/interval.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace haptel::ir {

inline double down(double value, int steps = 1)
{
    for (int i = 0; i < steps && value > -infinity; ++i) // as nextafter(), which is a call
        value = std::bit_cast<double>(std::bit_cast<int64_t>(value == 0 ? -0.0 : value) + (value > 0 ? -1 : 1));
    return value;
}
inline double up(double value, int steps = 1)
{
    return -down(-value, steps);
}

inline bool may_be_infinite(const Interval& a)
{
    return a.minimum == -infinity || a.maximum == infinity;
}

inline Interval negated(const Interval& a)
{
    return {-a.maximum, -a.minimum, a.may_be_nan};
}

// Never with -0 as an end: powers tell it from 0.
inline Interval absolute(const Interval& a)
{
    double low = std::fabs(a.minimum), high = std::fabs(a.maximum);
    return {a.contains(0) ? 0.0 : std::min(low, high), std::max(low, high)};
}

// Of f, which makes an interval of one value of each, at their ends. What is NaN does not count.
template <typename F>
Interval at_ends(const Interval& a, const Interval& b, const F& f)
{
    const Interval all = join(join(no_value, f(a.minimum, b.minimum)), f(a.maximum, b.maximum));
    if (a.is_point() || b.is_point()) return all;
    return join(join(all, f(a.minimum, b.maximum)), f(a.maximum, b.minimum));
}

// Of an operation that has a shape.
Interval by_shape(Op op, std::span<const Interval> operands);

} // namespace haptel::ir
