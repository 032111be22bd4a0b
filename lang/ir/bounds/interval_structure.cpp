// What a function's text says of its values beyond their intervals: which values are part of what it returns, and what
// the operands of one operation say together.
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

// How far a sum of multiples is written out: enough for the edges of a smoothstep.
constexpr uint32_t linear_steps_max = 16;

// Backward from what a function returns: which numbers become part of another. Those that are only compared, or made
// whole numbers of, may be infinite or NaN without a fault.
std::vector<bool> parts_of_results(const Function& function, const std::vector<const Instruction*>& makers)
{
    std::vector<bool> is_part(function.value_types.size(), false);
    std::vector<Value> open;
    const auto mark = [&](Value value) {
        if (function.type(value) != Type::real || is_part[value.index]) return;
        is_part[value.index] = true;
        open.push_back(value);
    };
    for (Value result : function.body.yields) mark(result);
    while (!open.empty()) {
        const Instruction* made = makers[open.back().index];
        open.pop_back();
        if (!made) continue;
        for (Value operand : made->operands) mark(operand);
        for (const Block& inner : blocks_of(*made))
            for (Value yield : inner.yields) mark(yield);
    }
    return is_part;
}

// A difference of terms that share others, as (r + k) - (r - k), is narrower than its parts are far apart: as exact
// numbers would have it, and as far around as code may be off that. Nothing where no term is shared.
std::optional<Interval> of_linear_sum(const IntervalEvaluator::Frame& frame, Value whole)
{
    struct Term {
        Value value;
        double factor;
    };
    Term open[linear_steps_max + 2] = {{whole, 1}}, terms[linear_steps_max + 2];
    size_t open_count = 1, term_count = 0;
    double constant = 0, rounding = 0;
    bool are_shared = false;
    const auto known = [&](Value value) -> const Interval& { return frame.values[value.index]; };
    const auto is_constant = [&](Value value) { return known(value).is_point() && known(value).is_finite(); };
    for (uint32_t steps = 0; open_count > 0; ++steps) {
        const auto [value, factor] = open[--open_count];
        if (value != whole) {
            if (!known(value).is_finite()) return std::nullopt;
            rounding += std::numeric_limits<double>::epsilon() * std::fabs(factor) * size_of(known(value));
        }
        const Instruction* made = frame.makers[value.index];
        const std::optional<Op> op = steps < linear_steps_max ? op_of(made) : std::nullopt;
        const auto part = [&](size_t i) { return made->operands[i]; };
        if (value != whole && is_constant(value)) {
            constant += factor * known(value).minimum;
        } else if (op == Op::add || op == Op::sub) {
            open[open_count++] = {part(0), factor};
            open[open_count++] = {part(1), op == Op::sub ? -factor : factor};
        } else if (op == Op::neg) {
            open[open_count++] = {part(0), -factor};
        } else if (op == Op::mul && (is_constant(part(0)) || is_constant(part(1)))) {
            const size_t by = is_constant(part(0)) ? 0 : 1;
            open[open_count++] = {part(1 - by), factor * known(part(by)).minimum};
        } else if (op == Op::div && is_constant(part(1)) && known(part(1)).minimum != 0) {
            open[open_count++] = {part(0), factor / known(part(1)).minimum};
        } else {
            Term* same = std::ranges::find(terms, terms + term_count, value, &Term::value);
            if (same == terms + term_count)
                terms[term_count++] = {value, factor};
            else
                same->factor += factor, are_shared = true;
        }
    }
    if (!are_shared) return std::nullopt;
    Interval sum{constant, constant};
    for (const Term& term : std::span(terms, term_count))
        sum = add(sum, multiply(known(term.value), {term.factor, term.factor}));
    const double slack = 4 * rounding;
    return std::isfinite(slack) ? std::optional(add(sum, {-slack, slack})) : std::nullopt;
}

} // namespace

const IntervalEvaluator::Structure& IntervalEvaluator::structure_of(uint32_t index)
{
    Structure& known = structures[index];
    if (!known.makers.empty()) return known;
    const Function& function = module.functions[index];
    known.makers.resize(function.value_types.size() + 1);
    for_each_instruction(function.body, [&](const Instruction& made) {
        for (Value result : made.results) known.makers[result.index] = &made;
    });
    known.is_part_of_result = parts_of_results(function, known.makers);
    return known;
}

// Whether it is `x == 0 ? a : y / x` of numbers.
bool IntervalEvaluator::is_guarded_division(const Frame& frame, const Instruction& made, Op op)
{
    if (op != Op::select) return false;
    const Instruction *test = frame.makers[made.operands[0].index], *division = frame.makers[made.operands[2].index];
    if (op_of(test) != Op::eq || op_of(division) != Op::div || test->operands[0] != division->operands[1]) return false;
    const Interval& zero = frame.values[test->operands[1].index];
    const auto is_finite = [&](Value value) { return frame.values[value.index].is_finite(); };
    return zero.is_point() && zero.minimum == 0 && std::ranges::all_of(division->operands, is_finite);
}

// What the operands say together: a square, a component of a unit vector, a division whose divisor was looked at.
Interval IntervalEvaluator::sharpened(const Frame& frame, const Instruction& made, Op op, const Interval& result)
{
    Interval sharp = result;
    const Value a = made.operands[0];
    const Instruction* second = made.operands.size() > 1 ? frame.makers[made.operands[1].index] : nullptr;
    if (op == Op::sub && op_of(second) == Op::detach && second->operands[0] == a && frame.values[a.index].is_finite())
        sharp = {0, 0}; // x - detach(x): a derivative, no value
    if (op == Op::sub || op == Op::add)
        if (const auto sum = of_linear_sum(frame, made.results[0]))
            sharp = {std::max(sharp.minimum, sum->minimum), std::min(sharp.maximum, sum->maximum), sharp.may_be_nan};
    if (op == Op::mul && a == made.operands[1]) sharp.minimum = std::max(sharp.minimum, 0.0);
    const std::optional<Op> divisor = op == Op::div ? op_of(second) : std::nullopt;
    if (divisor && is_length(*divisor) && std::ranges::find(second->operands, a) != second->operands.end())
        sharp = intersect(sharp, Interval{-1, 1, true});
    if (is_guarded_division(frame, made, op)) sharp.may_be_nan = frame.values[made.operands[1].index].may_be_nan;
    return sharp;
}

} // namespace haptel::ir
