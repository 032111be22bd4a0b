#include "lang/ir/bounds/seams.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

using Number = ValueNumbers::Number;

constexpr size_t crossings_max = 16; // of one value; of more, those that are continuous are settled first

const Crossing* crossing_of(const Seams::Operand& operand, uint32_t seam)
{
    if (operand.crossings)
        for (const Crossing& crossing : *operand.crossings)
            if (crossing.seam == seam) return &crossing;
    return nullptr;
}

void settle(const Crossing& crossing, Variation& variation)
{
    const Continuity left = crossing.is_continuous ? Continuity::c0 : Continuity::jump;
    if (left > variation.continuity) return;
    variation.continuity = left;
    variation.cause = crossing.cause; // also of what is as rough by itself: a fold is seen at its seam
}

// Whether a remainder by a whole number is compared with one.
bool compares_whole(const ValueNumbers::Remainder& row)
{
    const double limit = row.offset / row.factor;
    return row.by > 0 && std::floor(row.by) == row.by && std::floor(limit) == limit;
}

// Which operand the result is.
std::optional<size_t> choice_of(Op op, std::span<const Interval> values, bool on_seam)
{
    const auto is_below = [&](const Interval& a, const Interval& b) {
        return on_seam ? a.maximum <= b.minimum : a.maximum < b.minimum;
    };
    if (op == Op::select && values[0].is_point()) return values[0].minimum != 0 ? 1 : 2;
    if (op != Op::min && op != Op::max) return std::nullopt;
    if (is_below(values[0], values[1])) return op == Op::min ? 0 : 1;
    if (is_below(values[1], values[0])) return op == Op::min ? 1 : 0;
    return std::nullopt;
}

} // namespace

Variation settled(Variation variation)
{
    if (!variation.crossings) return variation;
    for (const Crossing& crossing : *variation.crossings) settle(crossing, variation);
    variation.crossings = nullptr;
    return variation;
}

Variation chosen_at(Variation variation, Span span)
{
    if (!variation.crossings) return variation;
    std::vector<Crossing> placed = *variation.crossings;
    for (Crossing& crossing : placed)
        if (crossing.cause.op == Op::lt || crossing.cause.op == Op::le) crossing.cause = {span, {}};
    variation.crossings = std::make_shared<const std::vector<Crossing>>(std::move(placed));
    return variation;
}

Variation without(Variation variation, uint32_t seam)
{
    if (!variation.crossings) return variation;
    std::vector<Crossing> left;
    for (const Crossing& crossing : *variation.crossings)
        if (crossing.seam != seam) left.push_back(crossing);
    variation.crossings = left.empty() ? nullptr : std::make_shared<const std::vector<Crossing>>(std::move(left));
    return variation;
}

Seams::Operand Seams::operand(const Variation& variation, const Interval& value, Type type)
{
    const bool is_constant = value.is_point() && value.is_finite();
    const Number number = is_constant                              ? numbers.constant(value.minimum)
                          : variation.number != ValueNumbers::none ? variation.number
                                                                   : numbers.unlike_any();
    return {number, value, is_constant ? nullptr : variation.crossings, type == Type::real};
}

void Seams::cross(std::span<const Operand> operands, const Interval& result, const NumberOf& number,
                  const ValueOf& value, const ChoiceOf& choice, Variation& made)
{
    std::vector<Number> all;
    for (const Operand& operand : operands) all.push_back(operand.number);
    made.number = number(all);

    std::map<uint32_t, Cause> crossed;
    for (const Operand& operand : operands)
        if (operand.crossings)
            for (const Crossing& crossing : *operand.crossings) crossed.emplace(crossing.seam, crossing.cause);
    std::vector<Crossing> crossings;
    for (const auto& [index, cause] : crossed) {
        const Seam seam = seams[index];
        Side sides[2];
        for (const bool is_after : {false, true}) {
            std::vector<Number> near, there;
            std::vector<Interval> on, beside;
            for (const Operand& operand : operands) {
                const Crossing* crossing = crossing_of(operand, index);
                Side side{operand.number, numbers.where(operand.number, seam.place, seam.value), operand.value};
                if (crossing) side = is_after ? crossing->after : crossing->before;
                near.push_back(side.near);
                there.push_back(side.there);
                on.push_back(side.value);
                // A little further than on the seam, in what is not known to stay as it is.
                const double further = rounding_share * size_of(operand.value);
                const bool stays = !crossing || numbers.constant_of(side.near);
                beside.push_back(stays             ? side.value
                                 : operand.is_real ? Interval{side.value.minimum - further,
                                                              side.value.maximum + further, side.value.may_be_nan}
                                                   : operand.value);
            }
            Side& made_side = sides[is_after];
            made_side.value = intersect(value(on), result);
            if (made_side.value.is_empty()) made_side.value = result;
            const Interval around = intersect(value(beside), result);
            const auto named = [&](const Interval& known, std::span<const Interval> values, bool on_seam,
                                   const std::vector<Number>& parts) {
                if (known.is_point() && known.is_finite()) return numbers.constant(known.minimum);
                const std::optional<size_t> chosen = choice(values, on_seam);
                return chosen ? parts[*chosen] : number(parts);
            };
            made_side.near = named(around, beside, false, near);
            made_side.there = named(made_side.value, on, true, there);
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
    made.crossings = crossings.empty() ? nullptr : std::make_shared<const std::vector<Crossing>>(std::move(crossings));
}

void Seams::cross(Op op, std::span<const Operand> operands, const Interval& result, Variation& made)
{
    cross(
        operands, result, [&](std::span<const Number> parts) { return numbers.of(op, parts); },
        [&](std::span<const Interval> values) { return evaluate(op, values); },
        [&](std::span<const Interval> values, bool on_seam) { return choice_of(op, values, on_seam); }, made);
}

// ---- where they are

uint32_t Seams::seam_at(Kind kind, Number place)
{
    const auto [known, is_new] = by_place.try_emplace({kind, place}, static_cast<uint32_t>(seams.size()));
    if (is_new) {
        const Number index = numbers.unlike_any(true);
        const Number value = kind == Kind::zero   ? numbers.constant(0)
                             : kind == Kind::half ? numbers.linear({index, 1, 0.5})
                                                  : index;
        seams.push_back({place, value, index});
    }
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
    const Number both[] = {a, b};
    const auto known = by_place.find({Kind::zero, numbers.of(Op::sub, both)});
    return known == by_place.end() ? std::nullopt : std::optional(known->second);
}

bool Seams::begin(Op op, std::span<const Operand> operands, const Interval& result, const Cause& cause, Variation& made)
{
    const Number a = operands[0].number;
    const auto both = [&](Op how) {
        const Number parts[] = {a, operands[1].number};
        return numbers.of(how, parts);
    };
    const bool rises_only = operands[0].value.minimum >= 0, falls_only = operands[0].value.maximum <= 0;
    const bool is_cut = op == Op::trunc || op == Op::r_to_i || op == Op::r_to_u;
    uint32_t index = 0, replaced = UINT32_MAX;
    Number before = ValueNumbers::none, after = ValueNumbers::none;
    if (op == Op::floor || op == Op::ceil || (is_cut && (rises_only || falls_only))) {
        index = seam_at(Kind::whole, a);
        const bool is_below = op == Op::floor || (is_cut && rises_only);
        before = numbers.linear({seams[index].index, 1, is_below ? -1.0 : 0.0});
        after = numbers.linear({seams[index].index, 1, is_below ? 0.0 : 1.0});
    } else if (op == Op::round) {
        index = seam_at(Kind::half, a);
        before = seams[index].index;
        after = numbers.linear({seams[index].index, 1, 1});
    } else if (op == Op::fract || (op == Op::mod && numbers.constant_of(operands[1].number).value_or(0) != 0)) {
        const double by = op == Op::fract ? 1 : *numbers.constant_of(operands[1].number);
        index = seam_at(Kind::whole, op == Op::fract ? a : both(Op::div));
        const Number parts[] = {a, numbers.linear({seams[index].index, by, 0})};
        after = numbers.of(Op::sub, parts);
        before = numbers.linear({after, 1, by});
    } else if (op == Op::lt || op == Op::le) {
        const Number apart = both(Op::sub);
        if (numbers.constant_of(apart)) return false;
        if (const auto row = numbers.remainder(apart); row && compares_whole(*row)) {
            // mod(u, b) < c of whole numbers is true of u where it is of floor(u), and changes with that alone
            const Number by = numbers.constant(row->by), limit = numbers.constant(-row->offset / row->factor);
            const Number turns[] = {row->of, by};
            replaced = seam_at(Kind::whole, numbers.of(Op::div, turns));
            index = seam_at(Kind::whole, row->of);
            for (const bool is_after : {false, true}) {
                const Number cell[] = {numbers.linear({seams[index].index, 1, is_after ? 0.0 : -1.0}), by};
                const Number rest = numbers.of(Op::mod, cell);
                const Number is_less[] = {rest, limit}, is_not_less[] = {limit, rest};
                (is_after ? after : before) =
                    row->factor > 0 ? numbers.of(Op::lt, is_less) : numbers.of(Op::le, is_not_less);
            }
        } else {
            index = seam_at(Kind::zero, apart);
            before = numbers.constant(1);
            after = numbers.constant(0);
        }
    } else {
        return false;
    }
    std::vector<Crossing> crossings;
    if (made.crossings)
        for (const Crossing& crossing : *made.crossings)
            if (crossing.seam != index && crossing.seam != replaced) crossings.push_back(crossing);
    const Seam seam = seams[index];
    crossings.push_back({index, side_of(seam, before, result), side_of(seam, after, result), false, cause});
    made.crossings = std::make_shared<const std::vector<Crossing>>(std::move(crossings));
    return true;
}

} // namespace haptel::ir
