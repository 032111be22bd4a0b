// What the operands of one operation say together, beyond their intervals.
#include "lang/ir/bounds/interval_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::ir {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

} // namespace

// A difference of terms that share others, as (r + k) - (r - k), is narrower than its parts are far apart: as exact
// numbers would have it, and as far around as code may be off that.
std::optional<Interval> IntervalEvaluator::of_linear_sum(const Frame& frame, Value whole) const
{
    struct Term {
        Value value;
        double factor;
    };
    std::vector<Term> open{{whole, 1}}, terms;
    double constant = 0, rounding = 0;
    const auto known = [&](Value value) -> const Interval& { return frame.values[value.index]; };
    const auto is_constant = [&](Value value) { return known(value).is_point() && known(value).is_finite(); };
    for (uint32_t steps = 0; !open.empty(); ++steps) {
        const auto [value, factor] = open.back();
        open.pop_back();
        if (value != whole) {
            if (!known(value).is_finite()) return std::nullopt;
            rounding += epsilon * std::fabs(factor) * size_of(known(value));
        }
        const Instruction* made = frame.makers[value.index];
        auto* operation = made && steps < linear_steps_max ? std::get_if<Operation>(&made->kind) : nullptr;
        const auto part = [&](size_t i) { return made->operands[i]; };
        if (value != whole && is_constant(value)) {
            constant += factor * known(value).minimum;
        } else if (operation && (operation->op == Op::add || operation->op == Op::sub)) {
            open.push_back({part(0), factor});
            open.push_back({part(1), operation->op == Op::sub ? -factor : factor});
        } else if (operation && operation->op == Op::neg) {
            open.push_back({part(0), -factor});
        } else if (operation && operation->op == Op::mul && (is_constant(part(0)) || is_constant(part(1)))) {
            const size_t by = is_constant(part(0)) ? 0 : 1;
            open.push_back({part(1 - by), factor * known(part(by)).minimum});
        } else if (operation && operation->op == Op::div && is_constant(part(1)) && known(part(1)).minimum != 0) {
            open.push_back({part(0), factor / known(part(1)).minimum});
        } else {
            const auto same = std::find_if(terms.begin(), terms.end(), [&](const Term& t) { return t.value == value; });
            if (same == terms.end())
                terms.push_back({value, factor});
            else
                same->factor += factor;
        }
    }
    Interval sum{constant, constant};
    for (const Term& term : terms) sum = add(sum, multiply(known(term.value), {term.factor, term.factor}));
    const double slack = 4 * rounding;
    return std::isfinite(slack) ? std::optional(add(sum, {-slack, slack})) : std::nullopt;
}

// Whether it is `x == 0 ? a : y / x` of numbers.
bool IntervalEvaluator::is_guarded_division(const Frame& frame, const Instruction& made, Op op) const
{
    if (op != Op::select) return false;
    const Instruction *test = frame.makers[made.operands[0].index], *division = frame.makers[made.operands[2].index];
    const auto is = [](const Instruction* by, Op which) {
        auto* operation = by ? std::get_if<Operation>(&by->kind) : nullptr;
        return operation && operation->op == which;
    };
    if (!is(test, Op::eq) || !is(division, Op::div) || test->operands[0] != division->operands[1]) return false;
    const Interval& zero = frame.values[test->operands[1].index];
    const auto is_finite = [&](Value value) { return frame.values[value.index].is_finite(); };
    return zero.is_point() && zero.minimum == 0 && is_finite(division->operands[0]) && is_finite(division->operands[1]);
}

// What the operands say together: a square, a component of a unit vector, a division whose divisor was looked at.
Interval IntervalEvaluator::sharpened(const Frame& frame, const Instruction& made, Op op, const Interval& result) const
{
    Interval sharp = result;
    const auto maker = [&](size_t operand) { return frame.makers[made.operands[operand].index]; };
    const auto made_by = [&](const Instruction* by, Op which) {
        auto* operation = by ? std::get_if<Operation>(&by->kind) : nullptr;
        return operation && operation->op == which;
    };
    if (op == Op::sub && made_by(maker(1), Op::detach) && maker(1)->operands[0] == made.operands[0] &&
        frame.values[made.operands[0].index].is_finite())
        sharp = {0, 0}; // x - detach(x): a derivative, no value
    if ((op == Op::sub || op == Op::add) && frame.structure.has_shared_terms[made.results[0].index])
        if (const auto sum = of_linear_sum(frame, made.results[0]))
            sharp = {std::max(sharp.minimum, sum->minimum), std::min(sharp.maximum, sum->maximum), sharp.may_be_nan};
    if (op == Op::mul && made.operands[0] == made.operands[1]) sharp.minimum = std::max(sharp.minimum, 0.0);
    if (op == Op::div) {
        const Instruction* divisor = maker(1);
        for (Op length : {Op::length2, Op::length3, Op::length4})
            if (made_by(divisor, length) && std::find(divisor->operands.begin(), divisor->operands.end(),
                                                      made.operands[0]) != divisor->operands.end())
                sharp = intersect(Interval{sharp.minimum, sharp.maximum, true}, Interval{-1, 1, sharp.may_be_nan});
    }
    if (is_guarded_division(frame, made, op)) sharp.may_be_nan = frame.values[made.operands[1].index].may_be_nan;
    return sharp;
}

} // namespace haptel::ir
