// `if`: what either arm yields, and how that varies where it may be one or the other.
#include "lang/ir/bounds/interval_evaluator.h"

namespace haptel::ir {
void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const If& choice)
{
    const Interval condition = frame.values[made.operands[0].index];
    Results all = nothing_yet(made.results.size()), arms[2];
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

// How what is chosen varies, where it may be either. `all`: the values of both, joined.
void IntervalEvaluator::choose(Frame& frame, const Instruction& made, const If& choice, const Results (&arms)[2],
                               Results& all)
{
    const bool is_either = !arms[0].values.empty() && !arms[1].values.empty();
    for (size_t i = 0; is_either && i < all.variations.size(); ++i)
        all.variations[i] = merge(arms[0].variations[i], arms[1].variations[i]);
    const Variation& by = frame.variations[made.operands[0].index];
    std::vector<Continuity> meets;
    std::optional<uint32_t> met; // the seam of the condition
    if (seams && by.is_active) {
        meets = meeting(frame, made, choice, all);
        const Instruction* comparison = frame.makers[made.operands[0].index];
        if (comparison && comparison->operands.size() == 2) {
            const std::vector<Seams::Operand> compared = seam_operands(frame, comparison->operands);
            met = seams->of_condition(compared[0].number, compared[1].number);
        }
    }
    for (size_t i = 0; i < all.variations.size(); ++i) {
        Variation& variation = all.variations[i];
        if (seams && is_either) {
            const auto of_arm = [&](size_t which) {
                return seams->operand(arms[which].variations[i], arms[which].values[i],
                                      frame.function.type(made.results[i]));
            };
            const Value condition = made.operands[0];
            const Seams::Operand operands[] = {seams->operand(by, frame.values[condition.index], Type::boolean),
                                               of_arm(0), of_arm(1)};
            seams->cross(Op::select, operands, all.values[i], variation);
            variation = chosen_at(std::move(variation), made.span);
        }
        if (!by.is_active) continue;
        variation.is_active = true;
        variation.kink = 0;
        if (!meets.empty() && meets[i] >= Continuity::c0) {
            roughen(variation, meets[i], {made.span, {}});
            if (met) variation = without(std::move(variation), *met);
        } else if (by.continuity <= Continuity::jump) {
            roughen(variation, by.continuity, {made.span, {}});
        }
    }
}

IntervalEvaluator::Results IntervalEvaluator::arm(Frame& frame, const Block& source, Value condition, bool taken,
                                                  Span span)
{
    if (depth >= depth_max) return unknown(frame.function, source.yields, span);
    ++depth;
    Results results;
    std::vector<Narrowed> undo;
    if (narrow(frame, condition, taken, undo)) {
        block(frame, source);
        results = gather(frame, source.yields);
    }
    for (auto narrowed = undo.rbegin(); narrowed != undo.rend(); ++narrowed)
        frame.values[narrowed->value.index] = narrowed->before;
    --depth;
    return results;
}

} // namespace haptel::ir
