#include "lang/ir/bounds/interval.h"

#include "lang/ir/bounds/interval_shape.h"
#include "lang/ir/int_range.h"
#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::ir {
namespace {

// A rounded value as the interval that holds the exact one.
Interval rounded(double value, bool is_exact)
{
    return is_exact ? Interval{value, value} : Interval{down(value), up(value)};
}
Interval sum(double a, double b)
{
    double s = a + b, b_part = s - a, error = (a - (s - b_part)) + (b - b_part);
    return rounded(s, std::isinf(a) || std::isinf(b) || error == 0);
}
// Of a product or a quotient, which has this sign however small it is.
Interval signed_as(bool is_negative, const Interval& a)
{
    return is_negative ? Interval{a.minimum, std::min(a.maximum, 0.0)} : Interval{std::max(a.minimum, 0.0), a.maximum};
}
Interval product(double a, double b)
{
    if (a == 0 || b == 0) return {0, 0}; // an infinite end is a bound, not a value
    double p = a * b;
    // the error of a product too small cannot be seen
    const bool is_exact = std::isinf(a) || std::isinf(b) || (std::fabs(p) > 1e-280 && std::fma(a, b, -p) == 0);
    return signed_as((a < 0) != (b < 0), rounded(p, is_exact));
}
Interval quotient(double a, double b)
{
    if (a == 0 || std::isinf(b)) return {0, 0};
    double q = a / b;
    const bool is_exact = std::isinf(a) || (std::fabs(q) > 1e-280 && std::fabs(a) > 1e-280 && std::fma(-q, b, a) == 0);
    return signed_as((a < 0) != (b < 0), rounded(q, is_exact));
}

Interval hull(std::initializer_list<Interval> parts)
{
    Interval all = not_a_number;
    for (const Interval& part : parts) {
        all.minimum = std::min(all.minimum, part.minimum);
        all.maximum = std::max(all.maximum, part.maximum);
    }
    all.may_be_nan = false;
    return all;
}

} // namespace

Interval add(const Interval& a, const Interval& b)
{
    bool opposite =
        (a.minimum == -infinity && b.maximum == infinity) || (a.maximum == infinity && b.minimum == -infinity);
    auto end = [](double x, double y, double unknown) {
        return std::isinf(x) && std::isinf(y) && x != y ? Interval{unknown, unknown} : sum(x, y);
    };
    return {end(a.minimum, b.minimum, -infinity).minimum, end(a.maximum, b.maximum, infinity).maximum, opposite};
}

Interval multiply(const Interval& a, const Interval& b)
{
    Interval all = hull({product(a.minimum, b.minimum), product(a.minimum, b.maximum), product(a.maximum, b.minimum),
                         product(a.maximum, b.maximum)});
    all.may_be_nan = (may_be_infinite(a) && b.contains(0)) || (may_be_infinite(b) && a.contains(0));
    return all;
}

namespace {

Interval divide(const Interval& a, const Interval& b)
{
    bool nan = (a.contains(0) && b.contains(0)) || (may_be_infinite(a) && may_be_infinite(b));
    if (b.contains(0)) return {-infinity, infinity, nan};
    Interval all = hull({quotient(a.minimum, b.minimum), quotient(a.minimum, b.maximum), quotient(a.maximum, b.minimum),
                         quotient(a.maximum, b.maximum)});
    all.may_be_nan = nan;
    return all;
}

Interval fraction(const Interval& a)
{
    if (may_be_infinite(a)) return {0, 1, true};
    double cell = std::floor(a.minimum);
    if (cell != std::floor(a.maximum)) return {0, 1};
    return add(a, {-cell, -cell});
}

Interval modulo(const Interval& a, const Interval& b)
{
    const bool is_bounded = !may_be_infinite(a) && !may_be_infinite(b) && !b.contains(0);
    if (!is_bounded || may_be_infinite(divide(a, b))) return {-infinity, infinity, true};
    if (b.is_point()) {
        double first = std::floor(a.minimum / b.minimum), last = std::floor(a.maximum / b.minimum);
        if (first == last) return add(a, negated(multiply(b, {first, first})));
    }
    // the quotient's rounding, or its underflow, may leave the last cell by as much as the operand's own
    const double slack = 4 * std::numeric_limits<double>::epsilon() * absolute(a).maximum + 1e-300;
    return {std::min(b.minimum, 0.0) - slack, std::max(b.maximum, 0.0) + slack};
}

Interval length(std::span<const Interval> parts)
{
    double low[4], high[4];
    for (size_t i = 0; i < parts.size(); ++i) {
        Interval part = absolute(parts[i]);
        low[i] = part.minimum, high[i] = part.maximum;
    }
    auto count = static_cast<int>(parts.size());
    return {down(semantics::length(low, count), 4), up(semantics::length(high, count), 4)};
}

Interval truth(bool may_be_false, bool may_be_true)
{
    return {may_be_false ? 0.0 : 1.0, may_be_true ? 1.0 : 0.0};
}

Interval to_integer(const Interval& a, Type type)
{
    IntRange full = full_range(type);
    auto low = static_cast<double>(full.minimum), high = static_cast<double>(full.maximum);
    Interval whole{std::clamp(std::trunc(a.minimum), low, high), std::clamp(std::trunc(a.maximum), low, high)};
    if (a.is_empty()) return {0, 0};
    return a.may_be_nan ? hull({whole, {0, 0}}) : whole;
}

// A comparison is decided where no pair of values says otherwise; of NaN it is false.
struct Comparison {
    const Interval &a, &b;
    bool nan = a.may_be_nan || b.may_be_nan, none = a.is_empty() || b.is_empty();

    Interval less() const { return truth(none || nan || a.maximum >= b.minimum, !none && a.minimum < b.maximum); }
    Interval less_or_equal() const
    {
        return truth(none || nan || a.maximum > b.minimum, !none && a.minimum <= b.maximum);
    }
    Interval equal() const
    {
        bool overlap = !none && a.minimum <= b.maximum && b.minimum <= a.maximum;
        return truth(nan || !(overlap && a.is_point() && b.is_point()), overlap);
    }
};

Interval exclusive_or(const Interval& a, const Interval& b)
{
    bool differ = a.minimum != b.minimum;
    return a.is_point() && b.is_point() ? truth(!differ, differ) : truth(true, true);
}

Interval on_integers(Op op, Type type, std::span<const Interval> operands)
{
    IntRange ranges[4];
    for (const Interval& operand : operands)
        if (operand.is_empty()) return operand; // comes of an arm that is never entered
    // A parameter without a range has no ends; it has 32 bits all the same.
    const auto end = [](double value) {
        return static_cast<int64_t>(std::clamp(value, static_cast<double>(INT32_MIN), static_cast<double>(UINT32_MAX)));
    };
    for (size_t i = 0; i < operands.size(); ++i) ranges[i] = {end(operands[i].minimum), end(operands[i].maximum)};
    IntRange range = range_of(op, type, {ranges, operands.size()});
    return {static_cast<double>(range.minimum), static_cast<double>(range.maximum)};
}

// Outward rounding leaves nothing beyond what the operation can be.
Interval clipped(Op op, Interval result)
{
    if (result.is_empty()) return result;
    const Traits& row = traits(op);
    return {std::max(result.minimum, row.least), std::min(result.maximum, row.most), result.may_be_nan};
}

Interval value_of(Op op, std::span<const Interval> x)
{
    const Interval& a = x[0];
    const Interval& b = x.size() > 1 ? x[1] : x[0];
    switch (op) {
#define ELEMENTARY(name, ...) case Op::name:
#include "lang/ir/ops.def"
    case Op::abs:
    case Op::sign:
    case Op::floor:
    case Op::ceil:
    case Op::trunc:
    case Op::round:
    case Op::sqrt:
    case Op::sinturn:
    case Op::costurn: return by_shape(op, x);
    case Op::add: return add(a, b);
    case Op::sub: return add(a, negated(b));
    case Op::mul: return multiply(a, b);
    case Op::div: return divide(a, b);
    case Op::neg: return negated(a);
    case Op::fma: {
        Interval both = multiply(a, b), all = add(both, x[2]);
        all.may_be_nan |= both.may_be_nan;
        return all;
    }
    case Op::min: return {std::min(a.minimum, b.minimum), std::min(a.maximum, b.maximum)};
    case Op::max: return {std::max(a.minimum, b.minimum), std::max(a.maximum, b.maximum)};
    case Op::fract: return fraction(a);
    case Op::mod: return modulo(a, b);
    case Op::length2:
    case Op::length3:
    case Op::length4: return length(x);
    case Op::spline: return {-infinity, infinity, true}; // images are the evaluator's to know
    case Op::image_width:
    case Op::image_height: return {1, INT32_MAX};
    case Op::detach: return a;
    case Op::lt:
    case Op::ilt:
    case Op::ult: return Comparison{a, b}.less();
    case Op::le:
    case Op::ile:
    case Op::ule: return Comparison{a, b}.less_or_equal();
    case Op::eq:
    case Op::ieq:
    case Op::ueq: return Comparison{a, b}.equal();
    case Op::is_finite: return truth(!a.is_finite(), !a.is_empty());
    case Op::land: return {std::min(a.minimum, b.minimum), std::min(a.maximum, b.maximum)};
    case Op::lor: return {std::max(a.minimum, b.minimum), std::max(a.maximum, b.maximum)};
    case Op::lxor: return exclusive_or(a, b);
    case Op::lnot: return {1 - a.maximum, 1 - a.minimum};
    case Op::select: return a.is_point() ? x[a.minimum != 0 ? 1 : 2] : join(x[1], x[2]);
    case Op::r_to_i: return to_integer(a, Type::i32);
    case Op::r_to_u: return to_integer(a, Type::u32);
    case Op::i_to_r:
    case Op::u_to_r:
    case Op::b_to_i: return a;
    case Op::iadd:
    case Op::isub:
    case Op::imul:
    case Op::idiv:
    case Op::irem:
    case Op::iand:
    case Op::ior:
    case Op::ixor:
    case Op::ishl:
    case Op::ishr:
    case Op::imin:
    case Op::imax:
    case Op::u_as_i: return on_integers(op, Type::i32, x);
    case Op::udiv:
    case Op::urem:
    case Op::ushr:
    case Op::umin:
    case Op::umax:
    case Op::i_as_u: return on_integers(op, Type::u32, x);
    }
    return {-infinity, infinity, true};
}

} // namespace

bool holds_pole(Op op, std::span<const Interval> operands)
{
    const Interval& a = operands[0];
    const Traits& row = traits(op);
    if (op == Op::div) return operands[1].contains(0);
    if (row.shape == Shape::power) return a.contains(0) && operands[1].minimum < 0;
    if (row.shape == Shape::tangent) return may_be_infinite(by_shape(op, operands)); // in double never met, only 1e16
    return row.has_pole_at_ends && (a.contains(row.from) || a.contains(row.to));
}

bool Interval::is_finite() const
{
    return !may_be_nan && minimum > -infinity && maximum < infinity && !is_empty();
}

double size_of(const Interval& a)
{
    return std::max(std::fabs(a.minimum), std::fabs(a.maximum));
}

bool are_close(const Interval& a, const Interval& b, double greatest)
{
    const double apart = std::max(std::fabs(a.maximum - b.minimum), std::fabs(b.maximum - a.minimum));
    return !a.may_be_nan && !b.may_be_nan && apart <= rounding_share * greatest;
}

Interval everything(Type type)
{
    if (type == Type::real) return {-infinity, infinity, true};
    if (type == Type::image) return any_image;
    IntRange full = full_range(type);
    return {static_cast<double>(full.minimum), static_cast<double>(full.maximum)};
}

Interval join(const Interval& a, const Interval& b)
{
    return {std::min(a.minimum, b.minimum), std::max(a.maximum, b.maximum), a.may_be_nan || b.may_be_nan};
}

Interval intersect(const Interval& a, const Interval& b)
{
    return {std::max(a.minimum, b.minimum), std::min(a.maximum, b.maximum), a.may_be_nan && b.may_be_nan};
}

Interval evaluate(Op op, std::span<const Interval> operands)
{
    const OpInfo& info = op_info(op);
    if (info.operands[0] != 'r' || info.result != 'r') return value_of(op, operands);
    // reals to a real: no value in, none out; NaN in, NaN out
    bool may_be_nan = false, is_empty = false;
    for (const Interval& operand : operands) {
        is_empty |= operand.is_empty();
        may_be_nan |= operand.may_be_nan;
    }
    Interval result = is_empty ? not_a_number : clipped(op, value_of(op, operands));
    result.may_be_nan |= may_be_nan;
    const bool swallows_nan =
        traits(op).shape == Shape::power &&
        ((operands[0].may_be_nan && operands[1].contains(0)) || (operands[1].may_be_nan && operands[0].contains(1)));
    return swallows_nan ? join(result, {1, 1}) : result; // pow(NaN, 0) and pow(1, NaN)
}

} // namespace haptel::ir
