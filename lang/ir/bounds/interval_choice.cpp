// `if`: what a condition says of the values that it compares, what either arm yields, and how that varies where it may
// be one or the other.
#include "lang/ir/bounds/interval_evaluator.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

// What is added to `unchanged` where it became `changed`; null: it became something else.
const Value* added_to(Value unchanged, const Instruction* changed)
{
    if (op_of(changed) != Op::add) return nullptr;
    if (changed->operands[0] == unchanged) return &changed->operands[1];
    return changed->operands[1] == unchanged ? &changed->operands[0] : nullptr;
}

using Undo = std::vector<std::pair<Value, Interval>>; // values as they were

// Shrinks what the condition compares to the values for which it is as `taken` says; false if there are none.
bool narrow(IntervalEvaluator::Frame& frame, Value condition, bool taken, Undo& undo)
{
    std::vector<std::pair<Value, bool>> open{{condition, taken}};
    while (!open.empty()) {
        const auto [value, holds] = open.back();
        open.pop_back();
        const Instruction* made = frame.makers[value.index];
        const std::optional<Op> op = op_of(made);
        if (op == Op::lnot) open.emplace_back(made->operands[0], !holds);
        if (op == (holds ? Op::land : Op::lor))
            for (Value part : made->operands) open.emplace_back(part, holds);
        const bool is_less = op == Op::lt || op == Op::ilt || op == Op::ult;
        const bool is_less_or_equal = op == Op::le || op == Op::ile || op == Op::ule;
        const bool is_equal = op == Op::eq || op == Op::ieq || op == Op::ueq;
        if (!is_less && !is_less_or_equal && !is_equal) continue;
        Interval &a = frame.values[made->operands[0].index], &b = frame.values[made->operands[1].index];
        const Interval before_a = a, before_b = b;
        // A comparison with NaN is false, which then says nothing of the other operand.
        if (!holds && (is_equal || a.may_be_nan || b.may_be_nan)) continue;
        undo.emplace_back(made->operands[0], a);
        undo.emplace_back(made->operands[1], b);
        if (holds) {
            a.maximum = std::min(a.maximum, before_b.maximum);
            b.minimum = std::max(before_a.minimum, b.minimum);
            a.may_be_nan = b.may_be_nan = false;
        }
        if (!holds || is_equal) {
            a.minimum = std::max(a.minimum, before_b.minimum);
            b.maximum = std::min(before_a.maximum, b.maximum);
        }
        if (a.is_empty() || b.is_empty()) return false;
    }
    return true;
}

} // namespace

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const If& choice)
{
    const Interval condition = frame.values[made.operands[0].index];
    Results all{std::vector<Interval>(made.results.size(), no_value), {}}, arms[2];
    for (size_t i : {0, 1}) {
        if (!condition.contains(i == 0 ? 1 : 0)) continue;
        arms[i] = arm(frame, choice.arms[i], made.operands[0], i == 0, made.span);
        if (!arms[i].values.empty()) join_into(all, arms[i]);
    }
    if (varying) {
        all.variations.resize(made.results.size());
        if (!condition.is_point()) choose(frame, made, choice, arms, all);
    }
    store(frame, made.results, all);
}

IntervalEvaluator::Results IntervalEvaluator::arm(Frame& frame, const Block& source, Value condition, bool taken,
                                                  Span span)
{
    if (depth >= depth_max) return unknown(frame.function, source.yields, span);
    ++depth;
    Results results;
    Undo undo;
    if (narrow(frame, condition, taken, undo)) {
        block(frame, source);
        results = gather(frame, source.yields);
    }
    for (auto narrowed = undo.rbegin(); narrowed != undo.rend(); ++narrowed)
        frame.values[narrowed->first.index] = narrowed->second;
    --depth;
    return results;
}

// How what is chosen varies, where it may be either. `all`: the values of both, joined.
void IntervalEvaluator::choose(Frame& frame, const Instruction& made, const If& choice, const Results (&arms)[2],
                               Results& all)
{
    const Variation& by = frame.variations[made.operands[0].index];
    std::vector<Continuity> meets(made.results.size(), Continuity::jump);
    std::optional<uint32_t> met; // the seam of the condition
    if (seams && by.is_active) {
        meets = meeting(frame, made, choice, all);
        const Instruction* comparison = frame.makers[made.operands[0].index];
        if (comparison && comparison->operands.size() == 2) {
            const std::vector<Seams::Operand> compared = seam_operands(frame, comparison->operands);
            met = seams->of_condition(compared[0].number, compared[1].number);
        }
    }
    const bool is_either = !arms[0].values.empty() && !arms[1].values.empty();
    for (size_t i = 0; i < all.variations.size(); ++i) {
        Variation& variation = all.variations[i];
        if (is_either) variation = merge(arms[0].variations[i], arms[1].variations[i]);
        if (seams && is_either) {
            const auto operand = [&](Value value, const Variation& how, const Interval& interval) {
                return seams->operand(how, interval, frame.function.type(value));
            };
            const Value condition = made.operands[0], result = made.results[i];
            const Seams::Operand operands[] = {operand(condition, by, frame.values[condition.index]),
                                               operand(result, arms[0].variations[i], arms[0].values[i]),
                                               operand(result, arms[1].variations[i], arms[1].values[i])};
            seams->cross(Op::select, operands, all.values[i], variation);
            choose_at(made.span, variation);
        }
        if (meets[i] < Continuity::c0) {
            jump_with(by, made.span, variation);
            continue;
        }
        variation.is_active = true;
        variation.kink = 0;
        roughen(variation, meets[i], {made.span, {}});
        std::erase_if(variation.crossings, [&](const Crossing& crossing) { return crossing.seam == met; });
    }
}

// Whether the two arms meet where the condition changes.
//
// With a condition `v < c` that is where v = c. There both arms are evaluated, and once more with v as the only thing
// that moves: arms of equal value make the result continuous, of equal slope in v as well C1, for what else they depend
// on is the same on both sides and so is its derivative. What one arm only adds to what the other leaves as it is
// counts alone: it must come to 0.
std::vector<Continuity> IntervalEvaluator::meeting(Frame& frame, const Instruction& made, const If& choice,
                                                   const Results& joined)
{
    std::vector<Continuity> meets(made.results.size(), Continuity::jump);
    const Instruction* comparison = frame.makers[made.operands[0].index];
    const std::optional<Op> op = op_of(comparison);
    if (is_trying || depth > 32 || (op != Op::lt && op != Op::le)) return meets;
    Value moving = comparison->operands[0], fixed = comparison->operands[1];
    if (!frame.variations[moving.index].is_active) std::swap(moving, fixed);
    const Interval border = frame.values[fixed.index];
    const Variation& of_moving = frame.variations[moving.index];
    if (!border.is_point() || frame.variations[fixed.index].is_active || of_moving.continuity < Continuity::c0)
        return meets;

    Frame there{frame.function, frame.values, std::vector<Variation>(frame.variations.size()), frame.structure,
                frame.tangents};
    for (size_t i = 0; i < there.variations.size(); ++i) there.variations[i].number = frame.variations[i].number;
    there.values[moving.index] = border;
    there.variations[moving.index] = axis(0);
    is_trying = true;
    ++depth;
    Results sides[2];
    for (size_t side : {0, 1}) {
        block(there, choice.arms[side]);
        sides[side] = gather(there, choice.arms[side].yields);
    }
    for (size_t side : {0, 1})
        for (size_t i = 0; i < meets.size(); ++i) {
            const Value changed = choice.arms[side].yields[i], unchanged = choice.arms[1 - side].yields[i];
            const Value* added = added_to(unchanged, frame.makers[changed.index]);
            if (!added) continue;
            sides[side].values[i] = there.values[added->index];
            sides[side].variations[i] = there.variations[added->index];
            sides[1 - side].values[i] = {0, 0};
            sides[1 - side].variations[i] = {};
        }
    --depth;
    is_trying = false;
    if (left == 0) return meets;
    for (size_t i = 0; i < meets.size(); ++i) {
        const Variation first = settled(sides[0].variations[i]), second = settled(sides[1].variations[i]);
        const double size = size_of(joined.values[i]);
        if (!std::isfinite(size) || !are_close(sides[0].values[i], sides[1].values[i], size)) continue;
        const double steepest = std::max({first.slope, second.slope, 1e-300});
        const bool bends = !are_close(first.gradient[0], second.gradient[0], steepest);
        const Continuity roughest = std::min({first.continuity, second.continuity, of_moving.continuity});
        meets[i] = !bends && roughest >= Continuity::c1 ? Continuity::c1 : Continuity::c0;
    }
    return meets;
}

} // namespace haptel::ir
