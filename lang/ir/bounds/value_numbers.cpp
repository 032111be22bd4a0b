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
    const Traits& row = traits(op);
    return row.shape == Shape::even || (row.shape == Shape::wave && row.crest == 0) || is_length(op);
}

bool is_odd(Op op)
{
    return op == Op::sin || op == Op::tan || op == Op::sinturn || op == Op::asin || op == Op::atan || op == Op::sinh ||
           op == Op::tanh || op == Op::asinh || op == Op::atanh || op == Op::sign || op == Op::trunc || op == Op::round;
}

bool makes_whole(Op op)
{
    return is_step(op) || op == Op::i_to_r || op == Op::u_to_r;
}

} // namespace

// ---- what there is

Number ValueNumbers::unlike_any(bool is_whole)
{
    const auto number = static_cast<Number>(definitions.size());
    definitions.push_back({Sum{0, {{number, 1}}}, is_whole});
    return number;
}

Number ValueNumbers::function(std::vector<uint64_t> key, bool is_whole)
{
    const auto [place, is_new] = known.try_emplace(key, none);
    if (is_new) {
        place->second = unlike_any(is_whole);
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

std::optional<double> ValueNumbers::constant_of(Number number) const
{
    const Sum& sum = definitions[number].sum;
    return sum.parts.empty() ? std::optional(sum.constant) : std::nullopt;
}

Number ValueNumbers::of(Other kind, uint64_t which, std::span<const Number> operands)
{
    std::vector<uint64_t> key{1'000 + static_cast<uint64_t>(kind), which};
    key.insert(key.end(), operands.begin(), operands.end());
    return function(std::move(key));
}

// ---- sums

void ValueNumbers::add(Sum& sum, const Sum& other, double factor)
{
    const auto total = [](double a, double b) {
        const double both = a + b;
        return std::fabs(both) <= 1e-12 * std::max(std::fabs(a), std::fabs(b)) ? 0.0 : both;
    };
    if (factor == 0) return;
    sum.constant = total(sum.constant, factor * other.constant);
    for (const Part& part : other.parts) {
        const auto place = std::ranges::lower_bound(sum.parts, part.number, {}, &Part::number);
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
    const auto [place, is_new] = known.try_emplace(std::move(key), static_cast<Number>(definitions.size()));
    if (is_new) definitions.push_back({std::move(sum)});
    return place->second;
}

Number ValueNumbers::sum(double constant, std::initializer_list<Part> parts)
{
    Sum all{constant, {}};
    for (const Part& part : parts) add(all, sum_of(part.number), part.factor);
    return of(std::move(all));
}

Number ValueNumbers::where(Number number, Number place, Number value)
{
    // `place` = factor * pivot + rest, so that pivot = (value - rest) / factor
    const Sum at = sum_of(place), whole = sum_of(number);
    if (at.parts.empty()) return number;
    const Part pivot = at.parts.front();
    const auto found = std::ranges::find(whole.parts, pivot.number, &Part::number);
    if (found == whole.parts.end()) return number;
    const double times = found->factor / pivot.factor;
    return sum(0, {{number, 1}, {place, -times}, {value, times}});
}

bool ValueNumbers::turn(Sum& sum)
{
    if ((sum.parts.empty() ? sum.constant : sum.parts[0].factor) >= 0) return false;
    sum.constant = 0.0 - sum.constant;
    for (Part& part : sum.parts) part.factor = -part.factor;
    return true;
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
    Sum sum{first.constant * second.constant, {}};
    add(sum, {0, first.parts}, second.constant);
    add(sum, {0, second.parts}, first.constant);
    for (const Part& x : first.parts)
        for (const Part& y : second.parts) {
            std::vector<uint64_t> key{static_cast<uint64_t>(Op::mul)};
            for (Number number : {x.number, y.number}) {
                const std::vector<uint64_t>& factors = definitions[number].function;
                if (is_function(number, Op::mul))
                    key.insert(key.end(), factors.begin() + 1, factors.end());
                else
                    key.push_back(number);
            }
            if (key.size() > 1 + factors_max) return std::nullopt;
            std::sort(key.begin() + 1, key.end());
            add(sum, {0, {{function(std::move(key)), 1}}}, x.factor * y.factor);
        }
    return of(std::move(sum));
}

Number ValueNumbers::product(Op op, Number a, Number b)
{
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
    return sum(0, {{function({static_cast<uint64_t>(op), first, second}), factor}});
}

// Sums and multiples of their operands, and products.
std::optional<Number> ValueNumbers::linear(Op op, std::span<const Number> operands)
{
    const Number a = operands[0];
    if (op == Op::neg) return sum(0, {{a, -1}});
    if (op == Op::add || op == Op::sub) return sum(0, {{a, 1}, {operands[1], op == Op::sub ? -1.0 : 1.0}});
    if (op == Op::fma) return sum(0, {{of(Op::mul, operands.first(2)), 1}, {operands[2], 1}});
    if (op != Op::mul && op != Op::div) return std::nullopt;
    const auto first = constant_of(a), second = constant_of(operands[1]);
    if (op == Op::mul && first) return sum(0, {{operands[1], *first}});
    if (op == Op::mul && second) return sum(0, {{a, *second}});
    if (second && *second != 0) return sum(0, {{a, 1 / *second}});
    const auto written = op == Op::mul ? written_out(a, operands[1]) : std::nullopt;
    return written ? written : product(op, a, operands[1]);
}

// Operations that do not see whole numbers in their operand, or give them on.
std::optional<Number> ValueNumbers::periodic(Op op, Number operand)
{
    if (op != Op::fract && op != Op::floor && op != Op::ceil && op != Op::sinturn && op != Op::costurn)
        return std::nullopt;
    Sum rest = sum_of(operand);
    const Sum whole = take_whole(rest);
    const bool is_turned = (is_even(op) || is_odd(op)) && turn(rest);
    if (is_turned) take_whole(rest);
    const Number inner = function({static_cast<uint64_t>(op), of(std::move(rest))}, makes_whole(op));
    Sum result = makes_whole(op) ? whole : Sum{};
    add(result, {0, {{inner, 1}}}, is_turned && is_odd(op) ? -1 : 1);
    return of(std::move(result));
}

Number ValueNumbers::of(Op op, std::span<const Number> operands)
{
    std::vector<Interval> points;
    for (Number number : operands)
        if (const auto value = constant_of(number)) points.push_back({*value, *value});
    if (points.size() == operands.size() && op_info(op).operands[0] != 'm') {
        const Interval result = evaluate(op, points);
        if (result.is_point() && result.is_finite()) return constant(result.minimum);
    }
    if (const auto number = linear(op, operands)) return *number;
    if (const auto number = periodic(op, operands[0])) return *number;
    if (op == Op::select && operands[1] == operands[2]) return operands[1];
    if (const auto condition = op == Op::select ? constant_of(operands[0]) : std::nullopt)
        return operands[*condition != 0 ? 1 : 2];
    bool is_turned = false;
    std::vector<uint64_t> key{static_cast<uint64_t>(op)};
    for (Number number : operands) {
        Sum sum = sum_of(number);
        const bool has_sign = (is_even(op) || is_odd(op)) && turn(sum);
        is_turned ^= has_sign;
        key.push_back(has_sign ? of(std::move(sum)) : number);
    }
    if (traits(op).commutes || is_length(op)) std::sort(key.begin() + 1, key.end());
    return sum(0, {{function(std::move(key), makes_whole(op)), is_odd(op) && is_turned ? -1.0 : 1.0}});
}

} // namespace haptel::ir
