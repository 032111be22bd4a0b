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

// Of what is right to four units in the last place.
Interval nearly(double low, double high, bool may_be_nan = false)
{
    return {down(low, 4), up(high, 4), may_be_nan};
}

// f rises over the part of the operand where it is defined, and elsewhere is NaN.
template <typename F>
Interval rising(const Interval& a, const Traits& row, const F& f)
{
    const Interval part = intersect(a, {row.from, row.to});
    if (part.is_empty()) return no_number;
    const bool may_be_nan = a.minimum < row.from || a.maximum > row.to, is_exact = row.ulp == 0;
    const double low = f(part.minimum), high = f(part.maximum);
    return is_exact ? Interval{low, high, may_be_nan} : nearly(low, high, may_be_nan);
}

// A wave between -1 and 1 with a crest at `crest` + k period and a trough half a period later.
template <typename F>
Interval wave(const Interval& a, double period, double crest, const F& f)
{
    const bool nan = may_be_infinite(a);
    const double size = size_of(a);
    if (!(size < 1e9)) return {-1, 1, nan};
    const double slack = 1e-15 * (size + period); // crests are placed with rounding
    auto meets = [&](double at) {
        double k = std::ceil((a.minimum - slack - at) / period);
        return at + k * period <= a.maximum + slack;
    };
    const double left = f(a.minimum), right = f(a.maximum);
    return {meets(crest + period / 2) ? -1 : down(std::min(left, right), 4),
            meets(crest) ? 1 : up(std::max(left, right), 4), nan};
}

template <typename F>
Interval tangent(const Interval& a, const Traits& row, const F& f)
{
    double cell = std::floor(a.minimum / pi + 0.5), other = std::floor(a.maximum / pi + 0.5);
    double to_pole = std::min(std::fabs(a.minimum - (cell - 0.5) * pi), std::fabs((other + 0.5) * pi - a.maximum));
    if (cell != other || !(std::fabs(cell) < 1e9) ||
        to_pole < 1e-15 * (1 + std::fabs(a.minimum) + std::fabs(a.maximum)))
        return {-infinity, infinity, may_be_infinite(a)};
    return rising(a, row, f);
}

// Of an operation that is monotonic in each operand.
Interval monotonic(Op op, const Interval& a, const Interval& b)
{
    const Interval all = at_ends(a, b, [op](double x, double y) { return exactly(value_at(op, x, y)); });
    return nearly(all.minimum, all.maximum);
}

// The direction of (x, y), behind the origin to half a turn either way.
Interval angle(Op op, const Interval& y, const Interval& x)
{
    const double half_turn = traits(op).period / 2;
    const bool cut = y.contains(0) && x.minimum <= 0;
    return cut ? nearly(-half_turn, half_turn) : monotonic(op, y, x);
}

Interval power(const Interval& a, const Interval& b)
{
    if (a.contains(0) && b.minimum < 0) return {-infinity, infinity, a.minimum < 0}; // pow(-0, -1) is -infinity
    Interval size = monotonic(Op::pow, absolute(a), b);
    size.minimum = std::max(0.0, size.minimum);
    if (a.minimum >= 0) return size;
    const bool is_whole = b.is_point() && std::isfinite(b.minimum) && b.minimum == std::floor(b.minimum);
    if (!is_whole) return {-size.maximum, size.maximum, true};
    if (std::fmod(b.minimum, 2) == 0) return size;
    return monotonic(Op::pow, a, b);
}

} // namespace

Interval by_shape(Op op, std::span<const Interval> x)
{
    const Interval& a = x[0];
    const Traits& row = traits(op);
    const auto value = [op](double v) { return value_at(op, v); };
    switch (row.shape) {
    case Shape::rising: return rising(a, row, value);
    case Shape::falling: return negated(rising(a, row, [&](double v) { return -value(v); }));
    case Shape::even: return rising(absolute(a), row, value);
    case Shape::wave: return wave(a, row.period, row.crest, value);
    case Shape::angle: return angle(op, a, x[1]);
    case Shape::tangent: return tangent(a, row, value);
    case Shape::power: return power(a, x[1]);
    case Shape::own: break;
    }
    return {-infinity, infinity, true};
}

} // namespace haptel::ir
