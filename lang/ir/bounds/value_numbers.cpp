#include "lang/ir/bounds/value_numbers.h"

#include "lang/ir/bounds/interval.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace haptel::ir {
namespace {

using Number = ValueNumbers::Number;

constexpr size_t parts_max = 64;    // of a sum: more are a number of their own
constexpr size_t products_max = 64; // that a product of sums is written out into: enough for noise of a quintic weight
constexpr size_t factors_max = 16;  // of each

// The first 36 bits, so that numbers that differ by rounding have the same.
uint64_t same_bits(double value)
{
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    if (!std::isfinite(value)) return std::bit_cast<uint64_t>(value);
    return std::bit_cast<uint64_t>(std::ldexp(std::nearbyint(std::ldexp(mantissa, 36)), exponent - 36) + 0.0);
}

bool is_even(Op op)
{
    return op == Op::abs || op == Op::cos || op == Op::cosh || op == Op::costurn || op == Op::length2 ||
           op == Op::length3 || op == Op::length4;
}

bool is_odd(Op op)
{
    return op == Op::sin || op == Op::tan || op == Op::sinturn || op == Op::asin || op == Op::atan || op == Op::sinh ||
           op == Op::tanh || op == Op::asinh || op == Op::atanh || op == Op::sign || op == Op::trunc || op == Op::round;
}

bool is_commutative(Op op)
{
    return op == Op::min || op == Op::max || op == Op::eq || op == Op::land || op == Op::lor || op == Op::lxor ||
           op == Op::length2 || op == Op::length3 || op == Op::length4;
}

bool makes_whole(Op op)
{
    return op == Op::floor || op == Op::ceil || op == Op::trunc || op == Op::round || op == Op::i_to_r ||
           op == Op::u_to_r;
}

} // namespace

// ---- what there is

Number ValueNumbers::unlike_any(bool whole)
{
    definitions.push_back({false, whole, {}, {}});
    return static_cast<Number>(definitions.size() - 1);
}

Number ValueNumbers::function(std::vector<uint64_t> key, bool whole)
{
    const auto [place, is_new] = known.try_emplace(key, none);
    if (is_new) {
        place->second = unlike_any(whole);
        definitions.back().function = std::move(key);
    }
    return place->second;
}

bool ValueNumbers::is_function(Number number, Op op) const
{
    const std::vector<uint64_t>& function = definitions[number].function;
    return !function.empty() && function[0] == static_cast<uint64_t>(op);
}

std::optional<ValueNumbers::Remainder> ValueNumbers::remainder(Number number) const
{
    const Sum sum = sum_of(number);
    if (sum.parts.size() != 1 || !is_function(sum.parts[0].number, Op::mod)) return std::nullopt;
    const std::vector<uint64_t>& function = definitions[sum.parts[0].number].function;
    const auto by = constant_of(static_cast<Number>(function[2]));
    return by ? std::optional(Remainder{static_cast<Number>(function[1]), *by, sum.parts[0].factor, sum.constant})
              : std::nullopt;
}

Number ValueNumbers::constant(double value)
{
    return of(Sum{value, {}});
}

std::optional<double> ValueNumbers::constant_of(Number number) const
{
    const Definition& definition = definitions[number];
    return definition.is_sum && definition.sum.parts.empty() ? std::optional(definition.sum.constant) : std::nullopt;
}

Number ValueNumbers::of(Other kind, uint64_t which, std::span<const Number> operands)
{
    std::vector<uint64_t> key{1'000 + static_cast<uint64_t>(kind), which};
    key.insert(key.end(), operands.begin(), operands.end());
    return function(std::move(key), false);
}

// ---- sums

ValueNumbers::Sum ValueNumbers::sum_of(Number number) const
{
    return definitions[number].is_sum ? definitions[number].sum : Sum{0, {{number, 1}}};
}

void ValueNumbers::add(Sum& sum, const Sum& other, double factor)
{
    const auto total = [](double a, double b) {
        const double both = a + b;
        return std::fabs(both) <= 1e-12 * std::max(std::fabs(a), std::fabs(b)) ? 0.0 : both;
    };
    if (factor == 0) return;
    sum.constant = total(sum.constant, factor * other.constant);
    for (const Part& part : other.parts) {
        const auto place = std::lower_bound(sum.parts.begin(), sum.parts.end(), part.number,
                                            [](const Part& a, Number number) { return a.number < number; });
        if (place == sum.parts.end() || place->number != part.number)
            sum.parts.insert(place, {part.number, factor * part.factor});
        else if ((place->factor = total(place->factor, factor * part.factor)) == 0)
            sum.parts.erase(place);
    }
}

Number ValueNumbers::of(Sum sum)
{
    const bool is_one = sum.parts.size() == 1 && same_bits(sum.parts[0].factor) == same_bits(1);
    if (is_one && sum.constant == 0) return sum.parts[0].number;
    if (sum.parts.size() > parts_max) return unlike_any();
    std::vector<uint64_t> key{2'000, same_bits(sum.constant)};
    for (const Part& part : sum.parts) {
        key.push_back(part.number);
        key.push_back(same_bits(part.factor));
    }
    const auto [place, is_new] = known.try_emplace(std::move(key), none);
    if (is_new) {
        definitions.push_back({true, false, std::move(sum), {}});
        place->second = static_cast<Number>(definitions.size() - 1);
    }
    return place->second;
}

Number ValueNumbers::linear(const Line& line)
{
    Sum sum{line.offset, {}};
    add(sum, sum_of(line.base), line.scale);
    return of(std::move(sum));
}

Number ValueNumbers::where(Number number, Number place, Number value)
{
    // `place` = factor * pivot + rest, so that pivot = (value - rest) / factor
    const Sum at = sum_of(place);
    if (at.parts.empty()) return number;
    const Part pivot = at.parts.front();
    Sum sum = sum_of(number);
    const auto found =
        std::find_if(sum.parts.begin(), sum.parts.end(), [&](const Part& part) { return part.number == pivot.number; });
    if (found == sum.parts.end()) return number;
    const double times = found->factor / pivot.factor;
    add(sum, at, -times);
    add(sum, sum_of(value), times);
    return of(std::move(sum));
}

bool ValueNumbers::turn(Sum& sum)
{
    if ((sum.parts.empty() ? sum.constant : sum.parts[0].factor) >= 0) return false;
    sum.constant = 0.0 - sum.constant;
    for (Part& part : sum.parts) part.factor = -part.factor;
    return true;
}

Number ValueNumbers::without_sign(Number number, bool& is_turned)
{
    Sum sum = sum_of(number);
    if (!turn(sum)) return number;
    is_turned = !is_turned;
    return of(std::move(sum));
}

ValueNumbers::Sum ValueNumbers::take_whole(Sum& sum) const
{
    Sum whole{std::floor(sum.constant), {}};
    for (const Part& part : sum.parts)
        if (definitions[part.number].is_whole && std::floor(part.factor) != 0)
            whole.parts.push_back({part.number, std::floor(part.factor)});
    add(sum, whole, -1);
    return whole;
}

// ---- operations

// Of sums of products: written out while that is short.
std::optional<Number> ValueNumbers::written_out(Number a, Number b)
{
    const Sum first = sum_of(a), second = sum_of(b);
    if ((first.parts.size() + 1) * (second.parts.size() + 1) > products_max) return std::nullopt;
    const auto factors_of = [&](Number number) {
        const std::vector<uint64_t>& function = definitions[number].function;
        return is_function(number, Op::mul) ? std::vector<uint64_t>(function.begin() + 1, function.end())
                                            : std::vector<uint64_t>{number};
    };
    Sum sum{first.constant * second.constant, {}};
    add(sum, {0, first.parts}, second.constant);
    add(sum, {0, second.parts}, first.constant);
    for (const Part& x : first.parts)
        for (const Part& y : second.parts) {
            std::vector<uint64_t> factors = factors_of(x.number), others = factors_of(y.number);
            if (factors.size() + others.size() > factors_max) return std::nullopt;
            factors.insert(factors.end(), others.begin(), others.end());
            std::sort(factors.begin(), factors.end());
            factors.insert(factors.begin(), static_cast<uint64_t>(Op::mul));
            add(sum, {0, {{function(std::move(factors), false), 1}}}, x.factor * y.factor);
        }
    return of(std::move(sum));
}

Number ValueNumbers::product(Op op, Number a, Number b)
{
    if (op == Op::mul)
        if (const auto sum = written_out(a, b)) return *sum;
    // signs and factors go out of it
    double factor = 1;
    const auto bare = [&](Number number, bool is_divisor) {
        Sum sum = sum_of(number);
        if (sum.parts.size() == 1 && sum.constant == 0) {
            factor = is_divisor ? factor / sum.parts[0].factor : factor * sum.parts[0].factor;
            return sum.parts[0].number;
        }
        if (!turn(sum)) return number;
        factor = -factor;
        return of(std::move(sum));
    };
    Number first = bare(a, false), second = bare(b, op == Op::div);
    if (op == Op::mul && first > second) std::swap(first, second);
    Sum sum;
    add(sum, {0, {{function({static_cast<uint64_t>(op), first, second}, false), 1}}}, factor);
    return of(std::move(sum));
}

std::optional<Number> ValueNumbers::real(Op op, std::span<const Number> operands)
{
    const auto scaled = [&](Number number, double factor) {
        Sum sum;
        add(sum, sum_of(number), factor);
        return of(std::move(sum));
    };
    const auto total = [&](Number a, Number b, double factor) {
        Sum sum = sum_of(a);
        add(sum, sum_of(b), factor);
        return of(std::move(sum));
    };
    if (op == Op::add || op == Op::sub) return total(operands[0], operands[1], op == Op::sub ? -1 : 1);
    if (op == Op::neg) return scaled(operands[0], -1);
    if (op == Op::fma) {
        const Number both[] = {operands[0], operands[1]};
        return total(of(Op::mul, both), operands[2], 1);
    }
    if (op == Op::mul || op == Op::div) {
        const auto first = constant_of(operands[0]), second = constant_of(operands[1]);
        if (op == Op::mul && first) return scaled(operands[1], *first);
        if (second && (op == Op::mul || *second != 0))
            return scaled(operands[0], op == Op::mul ? *second : 1 / *second);
        return product(op, operands[0], operands[1]);
    }
    if (op != Op::fract && op != Op::floor && op != Op::ceil && op != Op::sinturn && op != Op::costurn)
        return std::nullopt;
    Sum sum = sum_of(operands[0]);
    const Sum whole = take_whole(sum);
    if (op == Op::costurn && turn(sum)) take_whole(sum);
    const bool is_turned = op == Op::sinturn && turn(sum);
    if (is_turned) take_whole(sum);
    const Number rest = of(std::move(sum));
    Sum result;
    if (op == Op::floor || op == Op::ceil) result = whole;
    const Number inner = function({static_cast<uint64_t>(op), rest}, makes_whole(op));
    add(result, {0, {{inner, 1}}}, is_turned ? -1 : 1);
    return of(std::move(result));
}

Number ValueNumbers::of(Op op, std::span<const Number> operands)
{
    const OpInfo& info = op_info(op);
    const bool are_constant =
        std::all_of(operands.begin(), operands.end(), [&](Number number) { return constant_of(number).has_value(); });
    if (are_constant && info.operands[0] != 'm') {
        std::vector<Interval> points;
        for (Number number : operands) points.push_back({*constant_of(number), *constant_of(number)});
        const Interval result = evaluate(op, points);
        if (result.is_point() && result.is_finite()) return constant(result.minimum);
    }
    if (const auto number = real(op, operands)) return *number;
    if (op == Op::select && operands[1] == operands[2]) return operands[1];
    if (const auto condition = op == Op::select ? constant_of(operands[0]) : std::nullopt)
        return operands[*condition != 0 ? 1 : 2];
    bool is_turned = false;
    std::vector<uint64_t> key{static_cast<uint64_t>(op)};
    for (Number number : operands) key.push_back(is_even(op) || is_odd(op) ? without_sign(number, is_turned) : number);
    if (is_commutative(op)) std::sort(key.begin() + 1, key.end());
    Sum sum;
    add(sum, {0, {{function(std::move(key), makes_whole(op)), 1}}}, is_odd(op) && is_turned ? -1 : 1);
    return of(std::move(sum));
}

} // namespace haptel::ir
