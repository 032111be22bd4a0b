#include "lang/ir/bounds/seams.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

using Number = ValueNumbers::Number;

constexpr size_t crossings_max = 16; // of one value; of more, those that are continuous are settled first

void settle(const Crossing& crossing, Variation& variation)
{
    const Continuity left = crossing.is_continuous ? Continuity::c0 : Continuity::jump;
    if (left > variation.continuity) return;
    variation.continuity = left;
    variation.cause = crossing.cause; // also of what is as rough by itself: a fold is seen at its seam
}

bool is_whole(double value)
{
    return std::floor(value) == value;
}

// Which operand the result is.
std::optional<size_t> choice_of(Op op, std::span<const Interval> values)
{
    const auto is_below = [](const Interval& a, const Interval& b) { return a.maximum <= b.minimum; };
    if (op == Op::select && values[0].is_point()) return values[0].minimum != 0 ? 1 : 2;
    if (op != Op::min && op != Op::max) return std::nullopt;
    if (is_below(values[0], values[1])) return op == Op::min ? 0 : 1;
    if (is_below(values[1], values[0])) return op == Op::min ? 1 : 0;
    return std::nullopt;
}

} // namespace

Variation settled(Variation variation)
{
    for (const Crossing& crossing : variation.crossings) settle(crossing, variation);
    variation.crossings.clear();
    return variation;
}

void choose_at(Span span, Variation& variation)
{
    for (Crossing& crossing : variation.crossings)
        if (crossing.cause.op == Op::lt || crossing.cause.op == Op::le) crossing.cause = {span, {}};
}

Seams::Operand Seams::operand(const Variation& variation, const Interval& value, Type type)
{
    const bool is_real = type == Type::real;
    if (value.is_point() && value.is_finite()) return {numbers.constant(value.minimum), value, {}, is_real};
    const Number number = variation.number != ValueNumbers::none ? variation.number : numbers.unlike_any();
    return {number, value, variation.crossings, is_real};
}

void Seams::cross(std::span<const Operand> operands, const Interval& result, const NumberOf& number,
                  const ValueOf& value, Variation& made)
{
    struct Parts {
        std::vector<Number> numbers;
        std::vector<Interval> values;
    };
    Parts whole;
    std::map<uint32_t, Cause> crossed;
    for (const Operand& operand : operands) {
        whole.numbers.push_back(operand.number);
        whole.values.push_back(operand.value);
        for (const Crossing& crossing : operand.crossings) crossed.emplace(crossing.seam, crossing.cause);
    }
    made.number = number(whole.numbers, whole.values);

    std::vector<Crossing> crossings;
    for (const auto& [index, cause] : crossed) {
        const Seam seam = seams[index];
        Side sides[2];
        for (const bool is_after : {false, true}) {
            Parts on, beside;
            for (const Operand& operand : operands) {
                const auto crossing = std::ranges::find(operand.crossings, index, &Crossing::seam);
                const bool is_crossed = crossing != operand.crossings.end();
                const Side side =
                    !is_crossed
                        ? Side{operand.number, numbers.where(operand.number, seam.place, seam.value), operand.value}
                        : (is_after ? crossing->after : crossing->before);
                on.numbers.push_back(side.there);
                on.values.push_back(side.value);
                beside.numbers.push_back(side.near);
                // A little further than on the seam, in what is not known to stay as it is.
                const double further = rounding_share * size_of(operand.value);
                const bool stays = !is_crossed || numbers.constant_of(side.near);
                beside.values.push_back(
                    stays ? side.value
                    : operand.is_real
                        ? Interval{side.value.minimum - further, side.value.maximum + further, side.value.may_be_nan}
                        : operand.value);
            }
            Interval there = intersect(value(on.values), result);
            if (there.is_empty()) there = result;
            const auto named = [&](const Interval& known, const Parts& parts) {
                return known.is_point() && known.is_finite() ? numbers.constant(known.minimum)
                                                             : number(parts.numbers, parts.values);
            };
            const Interval around = intersect(value(beside.values), result);
            sides[is_after] = {named(around, beside), named(there, on), there};
        }
        if (sides[0].near == sides[1].near) continue;
        const double size = size_of(result);
        const bool is_continuous = sides[0].there == sides[1].there ||
                                   (std::isfinite(size) && are_close(sides[0].value, sides[1].value, size));
        crossings.push_back({index, sides[0], sides[1], is_continuous, cause});
    }
    for (const bool only_continuous : {true, false})
        if (crossings.size() > crossings_max)
            std::erase_if(crossings, [&](const Crossing& crossing) {
                const bool is_settled = crossing.is_continuous || !only_continuous;
                if (is_settled) settle(crossing, made);
                return is_settled;
            });
    made.crossings = std::move(crossings);
}

void Seams::cross(Op op, std::span<const Operand> operands, const Interval& result, Variation& made)
{
    const auto number = [&](std::span<const Number> parts, std::span<const Interval> values) {
        const std::optional<size_t> chosen = choice_of(op, values);
        return chosen ? parts[*chosen] : numbers.of(op, parts);
    };
    cross(operands, result, number, [&](std::span<const Interval> values) { return evaluate(op, values); }, made);
}

// ---- where they are

Number Seams::of(Op op, Number a, Number b)
{
    const Number both[] = {a, b};
    return numbers.of(op, both);
}

uint32_t Seams::seam_at(Number place, bool is_zero)
{
    const auto [known, is_new] = by_place.try_emplace({place, is_zero}, static_cast<uint32_t>(seams.size()));
    if (is_new) seams.push_back({place, is_zero ? numbers.constant(0) : numbers.unlike_any(true)});
    return known->second;
}

Side Seams::side_of(const Seam& seam, Number near, const Interval& value)
{
    const Number there = numbers.where(near, seam.place, seam.value);
    const auto constant = numbers.constant_of(there);
    return {near, there, constant ? Interval{*constant, *constant} : value};
}

std::optional<uint32_t> Seams::of_condition(Number a, Number b)
{
    const auto known = by_place.find({of(Op::sub, a, b), true});
    return known == by_place.end() ? std::nullopt : std::optional(known->second);
}

bool Seams::begin(Op op, std::span<const Operand> operands, const Interval& result, const Cause& cause, Variation& made)
{
    const Number a = operands[0].number, b = operands.back().number;
    const bool rises_only = operands[0].value.minimum >= 0, falls_only = operands[0].value.maximum <= 0;
    const bool is_cut = op == Op::trunc || op == Op::r_to_i || op == Op::r_to_u;
    const double by = op == Op::fract ? 1 : op == Op::mod ? numbers.constant_of(b).value_or(0) : 0;
    uint32_t index = 0;
    Number before = ValueNumbers::none, after = ValueNumbers::none;
    if (op == Op::floor || op == Op::ceil || op == Op::round || (is_cut && (rises_only || falls_only))) {
        index = seam_at(op == Op::round ? numbers.sum(-0.5, {{a, 1}}) : a);
        const double first = op == Op::floor || (is_cut && rises_only) ? -1 : 0;
        before = numbers.sum(first, {{seams[index].value, 1}});
        after = numbers.sum(first + 1, {{seams[index].value, 1}});
    } else if (by != 0) {
        index = seam_at(op == Op::fract ? a : of(Op::div, a, b));
        after = numbers.sum(0, {{a, 1}, {seams[index].value, -by}});
        before = numbers.sum(by, {{after, 1}});
    } else if (op == Op::lt || op == Op::le) {
        const Number apart = of(Op::sub, a, b);
        if (numbers.constant_of(apart)) return false;
        const auto row = numbers.remainder(apart);
        const double limit = row ? -row->offset / row->factor : 0;
        if (row && row->by > 0 && is_whole(row->by) && is_whole(limit)) {
            // mod(u, b) < c of whole numbers is true of u where it is of floor(u), and changes with that alone
            const Number turn = numbers.constant(row->by), end = numbers.constant(limit);
            const uint32_t replaced = seam_at(of(Op::div, row->of, turn));
            std::erase_if(made.crossings, [&](const Crossing& crossing) { return crossing.seam == replaced; });
            index = seam_at(row->of);
            const auto in_cell = [&](double cell) {
                const Number rest = of(Op::mod, numbers.sum(cell, {{seams[index].value, 1}}), turn);
                return row->factor > 0 ? of(Op::lt, rest, end) : of(Op::le, end, rest);
            };
            before = in_cell(-1);
            after = in_cell(0);
        } else {
            index = seam_at(apart, true);
            before = numbers.constant(1);
            after = numbers.constant(0);
        }
    } else {
        return false;
    }
    std::erase_if(made.crossings, [&](const Crossing& crossing) { return crossing.seam == index; });
    const Seam seam = seams[index];
    made.crossings.push_back({index, side_of(seam, before, result), side_of(seam, after, result), false, cause});
    return true;
}

} // namespace haptel::ir
