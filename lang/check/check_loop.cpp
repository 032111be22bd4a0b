// Loops: every one has a trip count that is bounded by what the text says.
#include "lang/check/body_checker.h"
#include "lang/ir/verify.h"
#include "lang/program/completion.h"
#include "lang/syntax/operators.h"

#include <algorithm>
#include <utility>

namespace haptel::lang {

using namespace ast;

namespace {

constexpr const char* loop_form = "a loop counts: for (int i = 0; i < 8; ++i)";

// The names that are assigned to anywhere in a statement.
std::vector<const NameExpression*> assigned_in(const Statement& s)
{
    std::vector<const NameExpression*> names;
    for_each_in(s, [&](const Statement& inner) {
        auto assignment = std::get_if<Assignment>(&inner.node);
        if (auto name = assignment ? root_of(*assignment) : nullptr) names.push_back(name);
    });
    return names;
}

// The first variable in `e` whose name stands in `names`.
const NameExpression* first_read(const Expression& e, const std::vector<const NameExpression*>& names)
{
    if (auto name = std::get_if<NameExpression>(&e.node)) {
        const bool listed =
            std::any_of(names.begin(), names.end(), [&](auto* other) { return other->name == name->name; });
        return listed ? name : nullptr;
    }
    for (const Expression* operand : operands_of(e))
        if (auto read = first_read(*operand, names)) return read;
    return nullptr;
}

bool names_counter(const Expression& e, const Symbol& counter)
{
    auto name = std::get_if<NameExpression>(&e.node);
    return name && name->symbol == &counter;
}

} // namespace

void BodyChecker::check(Statement& s, For& node)
{
    open_scope();
    Symbol* counter = nullptr;
    bool is_const = false;
    if (node.init) {
        statement(*node.init);
        if (auto declaration = std::get_if<Declaration>(&node.init->node)) {
            counter = const_cast<Symbol*>(declaration->symbol);
            is_const = declaration->is_const;
        }
    }
    for (const StatementPtr* repeated : {&node.step, &node.body})
        if (*repeated) forget_ranges_assigned_in(**repeated);
    if (node.condition) condition(node.condition, "as the condition of a loop");
    if (counter && !counter->type.is_error() && counter->type != int_type && counter->type != uint_type) {
        diagnostics.error(counter->span, "unbounded-loop", "a loop counts in int, found " + to_string(counter->type),
                          "count in int and compute the " + to_string(counter->type) + " from it: float x = 0.1 * i;");
        counter = nullptr;
    } else if (counter && is_const && !counter->type.is_error()) {
        diagnostics.error(counter->span, "read-only", quoted(counter->name) + " counts the loop and cannot be constant",
                          "leave 'const' out");
        counter = nullptr;
    } else if (!counter && in_damaged_body) {
        diagnostics.count_consequence(); // most likely what declares it could not be read
    } else if (!counter) {
        diagnostics.error(node.init ? node.init->span : s.span, "unbounded-loop",
                          "expected a counter declared in the loop", loop_form);
    }
    if (counter && counter->kind == SymbolKind::local) {
        plan(s, node, *counter);
        counter->read_only = "it counts the loop";
        counter->is_read = true;
    }
    const Flow before = flow;
    ++loop_depth;
    if (node.body) body(*node.body);
    --loop_depth;
    const Flow behind = std::exchange(flow, before);
    // What the body assigns on its way to its end has a value, if it runs at all.
    const bool reaches_end = node.plan.runs && behind.reachable && !completion_of(*node.body).breaks;
    for (size_t slot = 0; reaches_end && slot < before.variables.size(); ++slot)
        flow.variables[slot].assigned = behind.variables[slot].assigned;
    close_scope();
}

// Ranges of what the body assigns are not known at its start, nor behind it.
void BodyChecker::forget_ranges_assigned_in(const Statement& s)
{
    for (const NameExpression* name : assigned_in(s))
        if (const Symbol* local = find_local(name->name); local && local->kind == SymbolKind::local)
            flow.variables[local->slot].range =
                ir::full_range(local->type == uint_type ? ir::Type::u32 : ir::Type::i32);
}

// Sets loop.plan, and the counter's range inside the body, or says why the loop is not bounded.
void BodyChecker::plan(Statement& s, For& loop, Symbol& counter)
{
    auto init = std::get_if<Declaration>(&loop.init->node);
    if (!init->initializer || init->initializer->type.is_error()) return;
    auto refuse = [&](Span span, std::string message) -> Diagnostic& {
        Diagnostic& reported = diagnostics.error(span, "unbounded-loop", std::move(message), loop_form);
        return reported;
    };
    LoopPlan made;
    made.counter = &counter;
    made.start = init->initializer.get();

    // the condition: counter against bound
    if (!loop.condition) {
        refuse(s.span, "this loop has no condition, expected a bound for " + quoted(counter.name));
        return;
    }
    if (loop.condition->type.is_error()) return;
    auto chain = std::get_if<Chain>(&loop.condition->node);
    const bool simple = chain && chain->rest.size() == 1;
    const bool left = simple && names_counter(*chain->first, counter);
    const bool right = simple && names_counter(*chain->rest[0].operand, counter);
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
    if (made.bound->type != counter.type) {
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
        refuse(loop.step ? loop.step->span : s.span, "expected a step of " + quoted(counter.name) + ": ++" +
                                                         counter.name + ", --" + counter.name + ", " + counter.name +
                                                         " += 2");
        return;
    }
    stepped->symbol = &counter;
    if (expression(*step->value).is_error()) return;
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
    if (auto changed = loop.body ? first_read(*made.bound, assigned_in(*loop.body)) : nullptr) {
        refuse(made.bound->span,
               "the bound of this loop changes in its body: " + quoted(changed->name) + " is assigned there")
            .hint = "keep the bound in a variable of its own";
        return;
    }

    // how often, at most: the distance between the farthest start and bound, in steps
    const ir::IntRange from = range(*made.start), to = range(*made.bound);
    const bool up = made.step > 0;
    const int64_t stride = up ? made.step : -made.step;
    const int64_t farthest = up ? to.maximum - from.minimum : from.maximum - to.minimum;
    const int64_t nearest = up ? to.minimum - from.maximum : from.minimum - to.maximum;
    const int64_t trips = farthest < 0        ? 0
                          : made.is_inclusive ? farthest / stride + 1
                                              : (farthest + stride - 1) / stride;
    const ir::IntRange full = ir::full_range(counter.type == uint_type ? ir::Type::u32 : ir::Type::i32);
    const int64_t way_max = INT32_MAX - stride; // beyond, the last step could wrap
    if (trips > static_cast<int64_t>(ir::operations_limit) || farthest > way_max) {
        const bool bound_unknown = !to.is_constant() && (up ? to.maximum == full.maximum : to.minimum == full.minimum);
        const bool start_unknown =
            !from.is_constant() && (up ? from.minimum == full.minimum : from.maximum == full.maximum);
        if (bound_unknown || start_unknown) {
            const Expression& culprit = bound_unknown ? *made.bound : *made.start;
            const char* limit = up == bound_unknown ? "min" : "max";
            diagnostics.error(culprit.span, "unbounded-loop",
                              "cannot tell how often this loop runs: " + quoted(excerpt(culprit)) + " can be any " +
                                  to_string(counter.type),
                              std::string("write ") + limit + "(" + excerpt(culprit) + ", " +
                                  (up == bound_unknown ? "16" : "0") + "), or give the parameter a range: in 1 .. 16");
        } else if (trips <= static_cast<int64_t>(ir::operations_limit)) {
            refuse(loop.condition->span, "the bound of this loop may be " + std::to_string(farthest) +
                                             " from its start, expected at most " + std::to_string(way_max))
                .hint = "the last step could pass the greatest " + to_string(counter.type) + ": lower the bound";
        } else {
            diagnostics.error(loop.condition->span, "too-costly",
                              "this loop may run " + std::to_string(trips) + " times, expected at most " +
                                  std::to_string(ir::operations_limit),
                              "a texture is computed a thousand times a second: lower the bound");
        }
        return;
    }
    made.trip_max = static_cast<uint32_t>(trips);
    made.runs = loop.body && nearest >= (made.is_inclusive ? 0 : 1);
    made.difference_may_wrap = nearest < INT32_MIN;
    loop.plan = made;
    ir::IntRange inside = up ? ir::IntRange{from.minimum, to.maximum - (made.is_inclusive ? 0 : 1)}
                             : ir::IntRange{to.minimum + (made.is_inclusive ? 0 : 1), from.maximum};
    if (inside.minimum <= inside.maximum) flow.variables[counter.slot].range = inside;
}

} // namespace haptel::lang
