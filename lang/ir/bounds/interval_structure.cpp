// What of a function's text an evaluation asks about, found once.
#include "lang/ir/bounds/interval_evaluator.h"

#include <algorithm>

namespace haptel::ir {
namespace {

using Structure = IntervalEvaluator::Structure;

// Whether a sum of multiples, written out, names some value twice.
bool has_shared_terms(const std::vector<const Instruction*>& makers, Value whole)
{
    std::vector<Value> open{whole}, terms;
    for (uint32_t steps = 0; !open.empty(); ++steps) {
        const Value value = open.back();
        open.pop_back();
        const Instruction* made = makers[value.index];
        auto* operation =
            made && steps < IntervalEvaluator::linear_steps_max ? std::get_if<Operation>(&made->kind) : nullptr;
        const Op op = operation ? operation->op : Op::sin;
        if (op == Op::add || op == Op::sub || op == Op::neg || op == Op::mul || op == Op::div) {
            open.insert(open.end(), made->operands.begin(), made->operands.end());
        } else if (!made || !std::holds_alternative<RealConstant>(made->kind)) {
            if (std::find(terms.begin(), terms.end(), value) != terms.end()) return true;
            terms.push_back(value);
        }
    }
    return false;
}

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

} // namespace

const Structure& IntervalEvaluator::structure_of(uint32_t index)
{
    Structure& known = structures[index];
    if (!known.makers.empty()) return known;
    const Function& function = module.functions[index];
    const size_t count = function.value_types.size() + 1;
    known.makers.resize(count);
    for_each_instruction(function.body, [&](const Instruction& made) {
        for (Value result : made.results) known.makers[result.index] = &made;
    });
    known.has_shared_terms.resize(count);
    for (uint32_t i = 0; i + 1 < count; ++i) {
        auto* operation = known.makers[i] ? std::get_if<Operation>(&known.makers[i]->kind) : nullptr;
        if (operation && (operation->op == Op::add || operation->op == Op::sub))
            known.has_shared_terms[i] = has_shared_terms(known.makers, Value{i});
    }
    known.is_part_of_result = parts_of_results(function, known.makers);
    return known;
}

} // namespace haptel::ir
