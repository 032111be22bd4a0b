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

Interval interval_of(const IntRange& range)
{
    return {static_cast<double>(range.minimum), static_cast<double>(range.maximum)};
}

} // namespace

Interval add(const Interval& a, const Interval& b)
{
    if (a.is_zero() || b.is_zero()) return {a.minimum + b.minimum, a.maximum + b.maximum}; // exactly
    bool opposite =
        (a.minimum == -infinity && b.maximum == infinity) || (a.maximum == infinity && b.minimum == -infinity);
    auto end = [](double x, double y, double unknown) {
        return std::isinf(x) && std::isinf(y) && x != y ? Interval{unknown, unknown} : sum(x, y);
    };
    return {end(a.minimum, b.minimum, -infinity).minimum, end(a.maximum, b.maximum, infinity).maximum, opposite};
}

Interval multiply(const Interval& a, const Interval& b)
{
    if ((a.is_zero() && !may_be_infinite(b)) || (b.is_zero() && !may_be_infinite(a))) return {0, 0};
    const auto least = [&](double x) { return product(x, x < 0 ? b.maximum : b.minimum).minimum; };
    const auto greatest = [&](double x) { return product(x, x < 0 ? b.minimum : b.maximum).maximum; };
    const bool rises = b.minimum >= 0, falls = b.maximum <= 0; // with a
    const double low = rises   ? least(a.minimum)
                       : falls ? least(a.maximum)
                               : std::min(least(a.minimum), least(a.maximum));
    const double high = rises   ? greatest(a.maximum)
                        : falls ? greatest(a.minimum)
                                : std::max(greatest(a.minimum), greatest(a.maximum));
    return {low, high, (may_be_infinite(a) && b.contains(0)) || (may_be_infinite(b) && a.contains(0))};
}

namespace {

Interval divide(const Interval& a, const Interval& b)
{
    bool nan = (a.contains(0) && b.contains(0)) || (may_be_infinite(a) && may_be_infinite(b));
    if (b.contains(0)) return {-infinity, infinity, nan};
    Interval all = at_ends(a, b, quotient);
    all.may_be_nan = nan;
    return all;
}

Interval modulo(const Interval& a, const Interval& b)
{
    const bool are_bounded = !may_be_infinite(a) && !may_be_infinite(b) && !b.contains(0);
    if (!are_bounded || may_be_infinite(divide(a, b))) return {-infinity, infinity, true};
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
    const Interval full = everything(type);
    if (a.is_empty()) return {0, 0};
    const auto whole = [&](double end) { return std::clamp(std::trunc(end), full.minimum, full.maximum); };
    const Interval cut{whole(a.minimum), whole(a.maximum)};
    return a.may_be_nan ? join(cut, {0, 0}) : cut;
}

// Of a comparison that holds for all pairs of numbers, and for some of them; of NaN it is false.
Interval comparison(const Interval& a, const Interval& b, bool of_all, bool of_some)
{
    const bool is_of_numbers = !a.is_empty() && !b.is_empty(), nan = a.may_be_nan || b.may_be_nan;
    return truth(!is_of_numbers || nan || !of_all, is_of_numbers && of_some);
}

Interval equality(const Interval& a, const Interval& b)
{
    const bool overlap = a.minimum <= b.maximum && b.minimum <= a.maximum;
    return comparison(a, b, overlap && a.is_point() && b.is_point(), overlap);
}

Interval inverted(const Interval& truth)
{
    return {1 - truth.maximum, 1 - truth.minimum};
}

Interval on_integers(Op op, std::span<const Interval> operands)
{
    IntRange ranges[4];
    for (const Interval& operand : operands)
        if (operand.is_empty()) return operand; // comes of an arm that is never entered
    // A parameter without a range has no ends; it has 32 bits all the same.
    const auto end = [](double value) {
        return static_cast<int64_t>(std::clamp(value, static_cast<double>(INT32_MIN), static_cast<double>(UINT32_MAX)));
    };
    for (size_t i = 0; i < operands.size(); ++i) ranges[i] = {end(operands[i].minimum), end(operands[i].maximum)};
    const Type type = op_info(op).result == 'u' ? Type::u32 : Type::i32;
    return interval_of(range_of(op, type, {ranges, operands.size()}));
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
    case Op::min:
    case Op::land: return {std::min(a.minimum, b.minimum), std::min(a.maximum, b.maximum)};
    case Op::max:
    case Op::lor: return {std::max(a.minimum, b.minimum), std::max(a.maximum, b.maximum)};
    case Op::fract: return modulo(a, {1, 1});
    case Op::mod: return modulo(a, b);
    case Op::length2:
    case Op::length3:
    case Op::length4: return length(x);
    case Op::spline: return everything(Type::real); // images are the evaluator's to know
    case Op::image_channel:
    case Op::image_coarser: return any_image;
    case Op::i_to_r:
    case Op::u_to_r:
    case Op::detach: return a;
    case Op::lt:
    case Op::ilt:
    case Op::ult: return comparison(a, b, a.maximum < b.minimum, a.minimum < b.maximum);
    case Op::le:
    case Op::ile:
    case Op::ule: return comparison(a, b, a.maximum <= b.minimum, a.minimum <= b.maximum);
    case Op::eq:
    case Op::ieq:
    case Op::ueq: return equality(a, b);
    case Op::is_finite: return truth(!a.is_finite(), !a.is_empty());
    case Op::lxor: return inverted(equality(a, b));
    case Op::lnot: return inverted(a);
    case Op::select: return a.is_point() ? x[a.minimum != 0 ? 1 : 2] : join(x[1], x[2]);
    case Op::r_to_i: return to_integer(a, Type::i32);
    case Op::r_to_u: return to_integer(a, Type::u32);
    case Op::image_width:
    case Op::image_height:
    case Op::b_to_i:
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
    case Op::u_as_i:
    case Op::udiv:
    case Op::urem:
    case Op::ushr:
    case Op::umin:
    case Op::umax:
    case Op::i_as_u: return on_integers(op, x);
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

bool are_close(const Interval& a, const Interval& b, double greatest)
{
    const double apart = std::max(std::fabs(a.maximum - b.minimum), std::fabs(b.maximum - a.minimum));
    return !a.may_be_nan && !b.may_be_nan && apart <= rounding_share * greatest;
}

ImagePart ImagePart::of(double number)
{
    const auto whole = static_cast<int64_t>(number), by_channel = whole / levels;
    return {static_cast<int32_t>(by_channel / channels), static_cast<int32_t>(by_channel % channels),
            static_cast<int32_t>(whole % levels)};
}

Interval everything(Type type)
{
    if (type == Type::real) return {-infinity, infinity, true};
    if (type == Type::image) return any_image;
    return interval_of(full_range(type));
}

Interval exactly(double value)
{
    return std::isnan(value) ? no_number : Interval{value, value};
}

Interval exactly(Type type, uint32_t bits)
{
    return interval_of(constant_range(type, bits));
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
    // outward rounding leaves nothing beyond what the operation can be
    const Traits& row = traits(op);
    Interval result = is_empty ? no_number : intersect(value_of(op, operands), Interval{row.least, row.most, true});
    result.may_be_nan |= may_be_nan;
    const bool swallows_nan = row.shape == Shape::power && ((operands[0].may_be_nan && operands[1].contains(0)) ||
                                                            (operands[1].may_be_nan && operands[0].contains(1)));
    return swallows_nan ? join(result, {1, 1}) : result; // pow(NaN, 0) and pow(1, NaN)
}

} // namespace haptel::ir
