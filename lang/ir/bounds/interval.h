// Interval arithmetic over the operations of the IR: where a result must lie if the operands lie in theirs.
//
// An end that rounding moved is moved outward by one unit in the last place, that of an elementary function by four;
// exact ends stay, so that squares do not fall below 0.
#pragma once

#include "lang/ir/ir.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace haptel::ir {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

// Closed; no value at all where minimum > maximum. Integers and booleans as numbers.
struct Interval {
    double minimum, maximum;
    bool may_be_nan = false; // or, in a final result, infinite: the entry turns both into 0

    bool is_empty() const { return !(minimum <= maximum); }
    bool is_point() const { return minimum == maximum; }
    bool is_zero() const { return minimum == 0 && maximum == 0; }
    bool contains(double value) const { return minimum <= value && value <= maximum; }
    bool is_finite() const { return !may_be_nan && minimum > -infinity && maximum < infinity && !is_empty(); }
};

inline constexpr Interval no_value{infinity, -infinity};
inline constexpr Interval no_number{infinity, -infinity, true}; // of an operation on what it is not defined for

// Of an image: which part of which texture parameter it is, as a number that rises by parameter, channel and level.
// Counts of channels and levels as haptel_image has them: what is beyond a picture's last level is that level.
struct ImagePart {
    static constexpr int32_t channels = 8, levels = 32;

    int32_t parameter = 0, channel = 0, level = 0;

    double number() const { return (double{channels} * parameter + channel) * levels + level; }
    static ImagePart of(double number);
};
inline constexpr Interval any_image{-1, -1};

Interval everything(Type type);
Interval exactly(double value);
Interval exactly(Type type, uint32_t bits); // of an integer or a boolean
inline double size_of(const Interval& a)    // of what is farthest from 0
{
    return std::max(std::fabs(a.minimum), std::fabs(a.maximum));
}
inline bool is_bounded(const Interval& a)
{
    return std::isfinite(size_of(a));
}

// Whether the two are equal but for rounding: by no more than that part of the greatest value that there is.
inline constexpr double rounding_share = 1e-9;
bool are_close(const Interval& a, const Interval& b, double greatest);
inline Interval join(const Interval& a, const Interval& b)
{
    return {std::min(a.minimum, b.minimum), std::max(a.maximum, b.maximum), a.may_be_nan || b.may_be_nan};
}
// Of what is known by two ways: NaN only if both allow it.
inline Interval intersect(const Interval& a, const Interval& b)
{
    return {std::max(a.minimum, b.minimum), std::min(a.maximum, b.maximum), a.may_be_nan && b.may_be_nan};
}

// Of bounds of finite numbers: the product of 0 and an infinite end is 0.
Interval add(const Interval& a, const Interval& b);
Interval multiply(const Interval& a, const Interval& b);

Interval evaluate(Op op, std::span<const Interval> operands);

// Whether the operands hold a place where the operation is infinite: a divisor of 0, the logarithm of 0.
bool holds_pole(Op op, std::span<const Interval> operands);

} // namespace haptel::ir
