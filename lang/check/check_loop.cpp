// Loops: every one has a trip count that is bounded by what the text says.
#include "lang/check/body_checker.h"
#include "lang/ir/verify.h"
#include "lang/program/completion.h"
#include "lang/syntax/operators.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::lang {

using namespace ast;

namespace {

constexpr const char* loop_form = "a loop counts: for (int i = 0; i < 8; ++i)";

} // namespace

// The names that are arguments where a function of that name may write.
void BodyChecker::add_written(const Expression& e, std::vector<const NameExpression*>& names) const
{
    if (auto call = std::get_if<CallExpression>(&e.node))
        for (const Candidate& candidate : scope.functions(call->callee.text))
            for (size_t i = 0; i < std::min(candidate.parameters.size(), call->arguments.size()); ++i)
                if (auto name = root_of(*call->arguments[i]); name && candidate.parameters[i].is_written())
                    names.push_back(name);
    auto of_texture = std::get_if<CallExpression>(&e.node);
    const FunctionInfo* texture = of_texture ? scope.texture(of_texture->callee.text) : nullptr;
    for (size_t i = 0; texture && i < std::min(of_texture->names.size(), of_texture->arguments.size()); ++i) {
        const auto output = std::ranges::find(texture->parameters, of_texture->names[i].text, &ParameterInfo::name);
        auto name = root_of(*of_texture->arguments[i]);
        if (output != texture->parameters.end() && output->is_written() && name) names.push_back(name);
    }
    for (const Expression* operand : operands_of(e)) add_written(*operand, names);
}

// The names that are assigned to anywhere in a statement, if there is one.
std::vector<const NameExpression*> BodyChecker::assigned_in(const StatementPtr& s) const
{
    std::vector<const NameExpression*> names;
    if (!s) return names;
    for_each_in(*s, [&](const Statement& inner) {
        auto assignment = std::get_if<Assignment>(&inner.node);
        if (auto name = assignment ? root_of(*assignment->target) : nullptr) names.push_back(name);
        for (const Expression* e : expressions_of(inner)) add_written(*e, names);
    });
    return names;
}

namespace {

// The first variable in `e` whose name stands in `names`.
const NameExpression* first_read(const Expression& e, const std::vector<const NameExpression*>& names)
{
    if (auto name = std::get_if<NameExpression>(&e.node)) {
        return std::ranges::count(names, name->name, &NameExpression::name) > 0 ? name : nullptr;
    }
    for (const Expression* operand : operands_of(e))
        if (auto read = first_read(*operand, names)) return read;
    return nullptr;
}

} // namespace

void BodyChecker::check(Span span, For& node)
{
    open_scope();
    auto declaration = node.init ? std::get_if<Declaration>(&node.init->node) : nullptr;
    if (node.init) statement(*node.init);
    Symbol* counter = declaration ? declared.back() : nullptr;
    // Ranges of what the loop assigns are not known at its start, nor behind it.
    for (const StatementPtr* repeated : {&node.step, &node.body})
        for (const NameExpression* name : assigned_in(*repeated))
            if (const Symbol* local = find_local(name->name); local && local->kind == SymbolKind::local)
                flow.variables[local->slot].hold(full_range(local->type));
    for (const NameExpression* name : assigned_in(node.body)) // a turn may read what one before it has assigned
        if (Symbol* local = find_local(name->name)) local->parts_assigned = all_parts;
    ++choice_depth;
    if (node.condition) condition(node.condition, "as the condition of a loop");
    --choice_depth;
    if (!counter && in_damaged_body) {
        diagnostics.count_consequence(); // most likely what declares it could not be read
    } else if (!counter) {
        diagnostics.error(node.init ? node.init->span : span, "unbounded-loop",
                          "expected a counter declared in the loop", loop_form);
    } else if (!counter->type.is_error() && !is_integer(counter->type) && counter->type != float_type) {
        diagnostics.error(counter->span, "unbounded-loop", "a loop counts in int, found " + to_string(counter->type),
                          "count in int and compute the " + to_string(counter->type) + " from it: float x = 0.1 * i;");
    } else if (!counter->type.is_error() && declaration->is_const) {
        diagnostics.error(counter->span, "read-only", quoted(counter->name) + " counts the loop and cannot be constant",
                          "leave 'const' out");
    } else {
        plan(span, node, *counter);
        counter->read_only = "it counts the loop";
        counter->is_read = true;
    }
    const Flow before = flow;
    ++loop_depth;
    Flow* const around = std::exchange(switch_exit, nullptr);
    if (node.body) body(*node.body);
    switch_exit = around;
    --loop_depth;
    const Flow behind = std::exchange(flow, before);
    // What the body assigns on its way to its end has a value, if it runs at all.
    const Completion ends = node.body ? completion_of(*node.body) : Completion{};
    const bool reaches_end = node.plan.runs && behind.reachable && !ends.breaks && !ends.continues;
    for (size_t slot = 0; reaches_end && slot < before.variables.size(); ++slot)
        flow.variables[slot].assigned = behind.variables[slot].assigned;
    close_scope();
}

// Sets loop.plan, and the counter's range inside the body, or says why the loop is not bounded.
void BodyChecker::plan(Span span, For& loop, Symbol& counter)
{
    auto init = std::get_if<Declaration>(&loop.init->node);
    if (!init->initializer || init->initializer->type.is_error()) return;
    const auto refuse = [&](Span at, std::string message) -> Diagnostic& {
        return diagnostics.error(at, "unbounded-loop", std::move(message), loop_form);
    };
    LoopPlan made;
    made.counter = &counter;
    made.start = init->initializer.get();

    // the condition: counter against bound
    if (!loop.condition) {
        refuse(span, "this loop has no condition, expected a bound for " + quoted(counter.name));
        return;
    }
    if (loop.condition->type.is_error()) return;
    auto chain = std::get_if<Chain>(&loop.condition->node);
    const bool simple = chain && chain->rest.size() == 1;
    const auto is_counter = [&](const Expression& e) {
        auto name = std::get_if<NameExpression>(&e.node);
        return name && name->symbol == &counter;
    };
    const bool left = simple && is_counter(*chain->first), right = simple && is_counter(*chain->rest[0].operand);
    if (left == right) {
        refuse(loop.condition->span, "expected a comparison of " + quoted(counter.name) + " with a bound");
        return;
    }
    const BinaryOp compare = chain->rest[0].op;
    const bool is_less = compare == BinaryOp::less || compare == BinaryOp::less_equal;
    if (!is_less && compare != BinaryOp::greater && compare != BinaryOp::greater_equal) {
        Diagnostic& reported =
            refuse(loop.condition->span, "expected <, <=, > or >= between " + quoted(counter.name) + " and its bound");
        if (compare == BinaryOp::not_equal) reported.hint = "!= may step over the bound: write < or >";
        return;
    }
    made.is_inclusive = compare == BinaryOp::less_equal || compare == BinaryOp::greater_equal;
    made.bound = left ? chain->rest[0].operand.get() : chain->first.get();
    if (made.bound->type != counter.type && counter.type != float_type) {
        refuse(made.bound->span,
               "expected " + to_string(counter.type) + " as the bound of a loop, found " + to_string(made.bound->type))
            .hint = "write " + to_string(counter.type) + "(" + excerpt(*made.bound) + ")";
        return;
    }

    // the step: ++i, --i, i += c, i -= c
    auto step = loop.step ? std::get_if<Assignment>(&loop.step->node) : nullptr;
    auto stepped = step ? std::get_if<NameExpression>(&step->target->node) : nullptr;
    const bool adds = step && (step->op == BinaryOp::add || step->op == BinaryOp::subtract);
    if (!adds || !stepped || stepped->name != counter.name) {
        refuse(loop.step ? loop.step->span : span, "expected a step of " + quoted(counter.name) + ": ++" +
                                                       counter.name + ", --" + counter.name + ", " + counter.name +
                                                       " += 2");
        return;
    }
    stepped->symbol = &counter;
    if (expression(*step->value).is_error()) return;
    if (counter.type == float_type) return plan_of_reals(loop, made, is_less == left, *step);
    const ir::IntRange by = range(*step->value);
    if (!by.is_constant() || by.minimum == 0) {
        refuse(step->value->span, "expected a constant step, not 0");
        return;
    }
    made.step = step->op == BinaryOp::add ? by.minimum : -by.minimum;
    if ((is_less == left) != (made.step > 0)) {
        refuse(loop.step->span, quoted(counter.name) + " steps away from its bound").hint =
            made.step > 0 ? "write --" + counter.name : "write ++" + counter.name;
        return;
    }

    // the bound is computed once: what it is made from must stay as it is
    if (auto own = first_read(*made.bound, {stepped})) {
        refuse(made.bound->span, "the bound of this loop depends on its own counter " + quoted(own->name)).hint =
            "a bound is computed once, before the loop: leave " + quoted(own->name) + " out of it";
        return;
    }
    if (auto changed = first_read(*made.bound, assigned_in(loop.body))) {
        refuse(made.bound->span,
               "the bound of this loop changes in its body: " + quoted(changed->name) + " is assigned there")
            .hint = "keep the bound in a variable of its own";
        return;
    }

    // how often, at most: the distance between the farthest start and bound, in steps. Ranges as if it counted up
    const bool up = made.step > 0;
    const auto upwards = [&](ir::IntRange r) { return up ? r : ir::IntRange{-r.maximum, -r.minimum}; };
    const ir::IntRange from = upwards(range_over_calls(*made.start)), to = upwards(range_over_calls(*made.bound)),
                       full = upwards(full_range(counter.type));
    const int64_t stride = up ? made.step : -made.step, excess = made.is_inclusive ? 0 : 1;
    const int64_t farthest = to.maximum - from.minimum, nearest = to.minimum - from.maximum;
    const int64_t trips = farthest < 0 ? 0 : (farthest - excess + stride) / stride;
    const int64_t way_max = INT32_MAX - stride; // beyond, the last step could wrap
    const auto trips_max = static_cast<int64_t>(ir::operations_limit);
    if (trips > trips_max || farthest > way_max) {
        const bool bound_unknown = !to.is_constant() && to.maximum == full.maximum;
        const bool start_unknown = !from.is_constant() && from.minimum == full.minimum;
        if (bound_unknown || start_unknown) {
            if (is_never_called) return; // with which numbers is not known yet, and it is not compiled
            const Expression& culprit = bound_unknown ? *made.bound : *made.start;
            const bool is_upper = up == bound_unknown;
            diagnostics.error(culprit.span, "unbounded-loop",
                              "cannot tell how often this loop runs: " + quoted(excerpt(culprit)) + " can be any " +
                                  to_string(counter.type),
                              std::string(is_upper ? "write min(" : "write max(") + excerpt(culprit) +
                                  (is_upper ? ", 16" : ", 0") + "), or give the parameter a range: in 1 .. 16");
        } else if (trips <= trips_max) {
            refuse(loop.condition->span, "the bound of this loop may be " + std::to_string(farthest) +
                                             " from its start, expected at most " + std::to_string(way_max))
                .hint = "the last step could pass the greatest " + to_string(counter.type) + ": lower the bound";
        } else {
            diagnostics.error(loop.condition->span, "too-costly",
                              "this loop may run " + std::to_string(trips) + " times, expected at most " +
                                  std::to_string(trips_max),
                              "a texture is computed a thousand times a second: lower the bound");
        }
        return;
    }
    made.trip_max = static_cast<uint32_t>(trips);
    made.runs = loop.body && nearest >= excess;
    made.difference_may_wrap = nearest < INT32_MIN;
    loop.plan = made;
    const ir::IntRange inside = upwards({from.minimum, to.maximum - excess});
    if (inside.minimum <= inside.maximum) flow.variables[counter.slot].hold(inside);
}

// A float counts only from, to and by what is constant: how often is then certain, whatever the precision.
void BodyChecker::plan_of_reals(For& loop, LoopPlan made, bool is_upwards, const Assignment& step)
{
    double number[3] = {};
    const Expression* parts[] = {made.start, made.bound, step.value.get()};
    for (size_t i = 0; i < 3; ++i) {
        const Expression& part = *parts[i];
        if (first_not_constant(part) || !converts(part, float_type)) {
            diagnostics.error(part.span, "unbounded-loop",
                              "a float counts between constants and by a constant, found one that varies",
                              "count in int and compute the float from it: float x = 0.1 * i;");
            return;
        }
        number[i] = as_number(context.constants.value(part, float_type).front(), float_type);
    }
    const auto [start, bound, size] = number;
    made.real_start = start;
    made.real_step = step.op == BinaryOp::add ? size : -size;
    double farthest = (bound - start) / made.real_step; // in steps
    // Rounding decides nothing: a bound that a float of 32 bits would meet is met.
    if (std::abs(farthest - std::round(farthest)) < 1e-6) farthest = std::round(farthest);
    if ((made.real_step > 0) != is_upwards || !(std::abs(farthest) <= ir::operations_limit)) {
        diagnostics.error(step.value->span, "unbounded-loop",
                          "this step does not lead to the bound in at most " + std::to_string(ir::operations_limit) +
                              " turns",
                          loop_form);
        return;
    }
    const double whole = std::max(std::ceil(farthest), 0.0);
    const bool meets_bound = whole == farthest && made.is_inclusive;
    made.trip_max = static_cast<uint32_t>(whole) + (meets_bound && farthest >= 0 ? 1 : 0);
    made.runs = loop.body && made.trip_max > 0;
    loop.plan = made;
}

} // namespace haptel::lang
