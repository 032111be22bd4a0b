#include "lang/ir/bounds/interval_shape.h"

#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"

#include <numbers>

namespace haptel::ir {
namespace {

using std::numbers::pi;

// Of reals: what the operation is there.
double value_at(Op op, double a, double b = 0)
{
    Slot<double> result;
    execute(op, result, Slot<double>{a}, Slot<double>{b}, {}, {});
    return result.real;
}

// f rises over the interval and is exact, or right to four units in the last place.
template <typename F>
Interval rising(const Interval& a, const F& f, bool is_exact = false)
{
    double low = f(a.minimum), high = f(a.maximum);
    return is_exact ? Interval{low, high} : Interval{down(low, 4), up(high, 4)};
}

// Part of the operand where the function is defined; elsewhere it is NaN.
Interval within(const Interval& a, double low, double high, bool& may_be_nan)
{
    may_be_nan = a.minimum < low || a.maximum > high;
    return {std::max(a.minimum, low), std::min(a.maximum, high)};
}

template <typename F>
Interval rising_within(const Interval& a, double low, double high, const F& f, bool is_exact)
{
    bool nan = false;
    Interval part = within(a, low, high, nan);
    if (part.is_empty()) return not_a_number;
    Interval result = rising(part, f, is_exact);
    result.may_be_nan = nan;
    return result;
}

// A wave between -1 and 1 with a crest at `crest` + k period and a trough half a period later.
template <typename F>
Interval wave(const Interval& a, double period, double crest, const F& f)
{
    const bool nan = may_be_infinite(a);
    const double size = size_of(a);
    if (!(size < 1e9) || a.maximum - a.minimum >= period) return {-1, 1, nan};
    const double slack = 1e-15 * (size + period); // crests are placed with rounding
    auto meets = [&](double at) {
        double k = std::ceil((a.minimum - slack - at) / period);
        return at + k * period <= a.maximum + slack;
    };
    const double left = f(a.minimum), right = f(a.maximum);
    return {meets(crest + period / 2) ? -1 : down(std::min(left, right), 4),
            meets(crest) ? 1 : up(std::max(left, right), 4), nan};
}

Interval tangent(const Interval& a)
{
    double cell = std::floor(a.minimum / pi + 0.5), other = std::floor(a.maximum / pi + 0.5);
    double to_pole = std::min(std::fabs(a.minimum - (cell - 0.5) * pi), std::fabs((other + 0.5) * pi - a.maximum));
    if (cell != other || !(std::fabs(cell) < 1e9) ||
        to_pole < 1e-15 * (1 + std::fabs(a.minimum) + std::fabs(a.maximum)))
        return {-infinity, infinity, may_be_infinite(a)};
    return rising(a, [](double x) { return value_at(Op::tan, x); });
}

// The direction of (x, y), behind the origin to half a turn either way.
Interval angle(Op op, const Interval& y, const Interval& x)
{
    const double half_turn = traits(op).period / 2;
    const bool cut = y.contains(0) && x.minimum <= 0;
    if (cut) return {down(-half_turn, 4), up(half_turn, 4)};
    Interval all = not_a_number;
    for (double b : {y.minimum, y.maximum})
        for (double a : {x.minimum, x.maximum}) {
            double value = value_at(op, b, a);
            all = {std::min(all.minimum, value), std::max(all.maximum, value), false};
        }
    return {down(all.minimum, 4), up(all.maximum, 4)};
}

Interval power(const Interval& a, const Interval& b)
{
    auto corners = [&](const Interval& base) { // monotonic in each operand where the base is not negative
        Interval all = not_a_number;
        for (double x : {base.minimum, base.maximum})
            for (double y : {b.minimum, b.maximum}) {
                double value = value_at(Op::pow, x, y);
                all = {std::min(all.minimum, value), std::max(all.maximum, value), false};
            }
        return Interval{std::max(0.0, down(all.minimum, 4)), up(all.maximum, 4)};
    };
    if (a.contains(0) && b.minimum < 0) return {-infinity, infinity, a.minimum < 0}; // pow(-0, -1) is -infinity
    const Interval size = corners(absolute(a));
    if (a.minimum >= 0) return size;
    const bool is_whole = b.is_point() && std::isfinite(b.minimum) && b.minimum == std::floor(b.minimum);
    if (!is_whole) return {-size.maximum, size.maximum, true};
    if (std::fmod(b.minimum, 2) == 0) return size;
    double low = value_at(Op::pow, a.minimum, b.minimum), high = value_at(Op::pow, a.maximum, b.minimum);
    return {down(std::min(low, high), 4), up(std::max(low, high), 4)};
}

} // namespace

Interval by_shape(Op op, std::span<const Interval> x)
{
    const Interval& a = x[0];
    const Traits& row = traits(op);
    const bool is_exact = row.ulp == 0;
    const auto value = [op](double v) { return value_at(op, v); };
    switch (row.shape) {
    case Shape::rising: return rising_within(a, row.from, row.to, value, is_exact);
    case Shape::falling:
        return negated(rising_within(a, row.from, row.to, [&](double v) { return -value(v); }, is_exact));
    case Shape::even: return rising(absolute(a), value, is_exact);
    case Shape::wave: return wave(a, row.period, row.crest, value);
    case Shape::angle: return angle(op, a, x[1]);
    case Shape::tangent: return tangent(a);
    case Shape::power: return power(a, x[1]);
    case Shape::own: break;
    }
    return {-infinity, infinity, true};
}

} // namespace haptel::ir
