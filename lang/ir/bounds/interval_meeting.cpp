// Whether the two arms of an `if` meet where its condition changes.
//
// With a condition `v < c` that is where v = c. There both arms are evaluated, and once more with v as the only thing
// that moves: arms of equal value make the result continuous, of equal slope in v as well C1, for what else they depend
// on is the same on both sides and so is its derivative. What one arm only adds to what the other leaves as it is
// counts alone: it must come to 0.
#include "lang/ir/bounds/interval_evaluator.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

// What is added to `unchanged` where it became `changed`; null: it became something else.
const Value* added_to(Value unchanged, const Instruction* changed)
{
    auto* operation = changed ? std::get_if<Operation>(&changed->kind) : nullptr;
    if (!operation || operation->op != Op::add) return nullptr;
    if (changed->operands[0] == unchanged) return &changed->operands[1];
    return changed->operands[1] == unchanged ? &changed->operands[0] : nullptr;
}

} // namespace

std::vector<Continuity> IntervalEvaluator::meeting(Frame& frame, const Instruction& made, const If& choice,
                                                   const Results& joined)
{
    std::vector<Continuity> meets(made.results.size(), Continuity::jump);
    const Instruction* comparison = frame.makers[made.operands[0].index];
    auto* operation = comparison ? std::get_if<Operation>(&comparison->kind) : nullptr;
    if (is_trying || depth > 32 || !operation || (operation->op != Op::lt && operation->op != Op::le)) return meets;
    Value moving = comparison->operands[0], fixed = comparison->operands[1];
    if (!frame.variations[moving.index].is_active) std::swap(moving, fixed);
    const Interval border = frame.values[fixed.index];
    const Variation& of_moving = frame.variations[moving.index];
    if (!border.is_point() || frame.variations[fixed.index].is_active || of_moving.continuity < Continuity::c0)
        return meets;

    Frame there{frame.function, frame.values, std::vector<Variation>(frame.variations.size()), frame.structure,
                frame.has_tangent};
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
        meets[i] = Continuity::c0;
        const double steepest = std::max({first.slope, second.slope, 1e-300});
        const bool bends = !are_close(first.gradient[0], second.gradient[0], steepest);
        if (!bends && std::min(first.continuity, second.continuity) >= Continuity::c1 &&
            of_moving.continuity >= Continuity::c1)
            meets[i] = Continuity::c1;
    }
    return meets;
}

} // namespace haptel::ir
