// Statements to regions that yield what they change.
//
// The rest of a block behind a statement that may leave it runs only if it did not. Where one arm of an `if` goes on
// and the others leave, the rest moves into that arm and no flag is needed: the usual early return.
#include "lang/lower/lowering.h"
#include "lang/program/completion.h"
#include "lang/syntax/operators.h"
#include "lang/syntax/swizzle.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;
using ir::Op;
using ir::Value;

namespace {

constexpr uint32_t region_max = 256;

std::vector<const Statement*> listed(const Statement* first, std::span<const StatementPtr> rest)
{
    std::vector<const Statement*> all;
    if (first) all.push_back(first);
    for (const StatementPtr& s : rest) all.push_back(s.get());
    return all;
}

// The statements of a case, without the break that ends it.
std::span<const StatementPtr> up_to_break(const Switch::Case& one)
{
    const std::span<const StatementPtr> all = std::get<ast::Scope>(one.body->node).statements;
    const bool ends_in_break = !all.empty() && all.back() && std::holds_alternative<Break>(all.back()->node);
    return all.first(all.size() - (ends_in_break ? 1 : 0));
}

// Whether what follows can stand in the one arm or case that goes on.
bool goes_on_once(const Statement& s)
{
    size_t going_on = 0;
    if (auto branch = std::get_if<If>(&s.node)) {
        going_on = branch->arms.back().condition ? 1 : 0;
        for (const If::Arm& arm : branch->arms) going_on += !arm.body || completion_of(*arm.body).falls_through;
    } else if (auto choice = std::get_if<Switch>(&s.node)) {
        going_on = std::ranges::none_of(choice->cases, &Switch::Case::is_default) ? 1 : 0;
        for (const Switch::Case& one : choice->cases) {
            const Completion ends = completion_of(up_to_break(one));
            if (ends.breaks) return false;
            going_on += ends.falls_through;
        }
    }
    return going_on == 1;
}

} // namespace

BodyLowering::BodyLowering(ModuleLowering& module_lowering, std::string name, uint32_t slot_count)
    : builder(module_lowering.module, std::move(name)), owner(module_lowering), variables(slot_count + 4)
{
}

Values BodyLowering::whole_body(const Statement& body, Type result)
{
    result_type = result;
    builder.span = body.span;
    variables[returned_slot()] = variables[broken_slot()] = variables[turned_slot()] = {builder.boolean(false)};
    variables[result_slot()] = zeros(result);
    sequence(std::get<ast::Scope>(body.node).statements);
    return variables[result_slot()];
}

// ---- flow

BodyLowering::Slots BodyLowering::changed_slots(const std::vector<const Statement*>& statements, Completion ends) const
{
    Slots slots = changed_in(statements);
    if (ends.returns) slots.insert(slots.end(), {returned_slot(), result_slot()});
    if (ends.breaks) slots.push_back(broken_slot());
    if (ends.continues) slots.push_back(turned_slot());
    return slots;
}

Values BodyLowering::gather(const Slots& slots) const
{
    Values flat;
    for (uint32_t slot : slots) flat.insert(flat.end(), variables[slot].begin(), variables[slot].end());
    return flat;
}

void BodyLowering::scatter(const Slots& slots, std::span<const Value> parts)
{
    for (uint32_t slot : slots)
        for (Value& part : variables[slot]) {
            part = parts.front();
            parts = parts.subspan(1);
        }
}

// Runs both arms from the same state; afterwards the changed slots hold what the arm that was taken made of them.
void BodyLowering::choose(Value condition, const Slots& changed, const std::function<void()>& then_arm,
                          const std::function<void()>& else_arm)
{
    if (region_depth >= region_max) {
        owner.diagnostics.error(builder.span, "too-deep",
                                "ifs, loops and early returns nest more than " + std::to_string(region_max) +
                                    " deep here");
        return;
    }
    const Nesting region(region_depth);
    depth = std::max(depth, region_depth);
    const Values before = gather(changed);
    const auto run = [&](const std::function<void()>& arm) {
        scatter(changed, before);
        arm();
        return gather(changed);
    };
    const Values after = builder.if_else(condition, [&] { return run(then_arm); }, [&] { return run(else_arm); });
    scatter(changed, after);
}

Value BodyLowering::left()
{
    const Value ended = builder.operation(Op::lor, {variables[returned_slot()][0], variables[broken_slot()][0]});
    return builder.operation(Op::lor, {ended, variables[turned_slot()][0]});
}

void BodyLowering::sequence(Statements statements)
{
    for (; !statements.empty(); statements = statements.subspan(1)) {
        const Statement& s = *statements.front();
        const Statements rest = statements.subspan(1);
        const Completion ends = completion_of(s);
        if (!ends.may_leave()) {
            statement(s, {});
            continue;
        }
        if (!ends.falls_through || rest.empty()) return statement(s, {});
        if (goes_on_once(s)) return statement(s, rest);
        statement(s, {});
        const Slots changed = changed_slots(listed(nullptr, rest), completion_of(rest));
        return choose(left(), changed, [] {}, [&] { sequence(rest); });
    }
}

// `rest` follows inside the arm of an `if` or `switch` that goes on; empty for other statements.
void BodyLowering::statement(const Statement& s, Statements rest)
{
    const Nesting nesting(owner.nesting);
    if (too_deep(s.span)) return;
    builder.span = s.span;
    if (auto declaration = std::get_if<Declaration>(&s.node)) {
        lower(*declaration);
    } else if (auto assignment = std::get_if<Assignment>(&s.node)) {
        lower(*assignment);
    } else if (auto evaluated = std::get_if<ExpressionStatement>(&s.node)) {
        if (!s.written.empty()) expression(*evaluated->expression);
    } else if (auto scope = std::get_if<ast::Scope>(&s.node)) {
        sequence(scope->statements);
    } else if (auto branch_node = std::get_if<If>(&s.node)) {
        Completion either = completion_of(s);
        either.add(completion_of(rest));
        const Slots changed = changed_slots(listed(&s, rest), either);
        branch(*branch_node, 0, rest, changed);
    } else if (auto choice = std::get_if<Switch>(&s.node)) {
        lower(*choice, s, rest);
    } else if (auto loop = std::get_if<For>(&s.node)) {
        lower(*loop);
    } else if (std::holds_alternative<Break>(s.node)) {
        variables[broken_slot()] = {builder.boolean(true)};
    } else if (std::holds_alternative<Continue>(s.node)) {
        variables[turned_slot()] = {builder.boolean(true)};
    } else if (auto leave = std::get_if<Return>(&s.node)) {
        if (leave->value) variables[result_slot()] = converted(*leave->value, result_type);
        variables[returned_slot()] = {builder.boolean(true)};
    }
}

// From arm `index` on: "if (c) a else (the others)".
void BodyLowering::branch(const If& node, size_t index, Statements rest, const Slots& changed)
{
    if (index == node.arms.size()) return sequence(rest);
    const If::Arm& arm = node.arms[index];
    const auto take_arm = [&] { take(arm.body ? Statements(&arm.body, 1) : Statements{}, rest, changed); };
    if (!arm.condition) return take_arm();
    const Value condition = converted(*arm.condition, bool_type)[0];
    choose(condition, changed, take_arm, [&] { branch(node, index + 1, rest, changed); });
}

void BodyLowering::take(Statements arm, Statements rest, const Slots& changed)
{
    sequence(arm);
    const Completion ends = completion_of(arm);
    if (rest.empty() || !ends.falls_through) return;
    if (!ends.may_leave()) return sequence(rest);
    choose(left(), changed, [] {}, [&] { sequence(rest); });
}

// The slot of a loop that was left serves for a break that stands in front of other statements of its case.
void BodyLowering::lower(const Switch& node, const Statement& s, Statements rest)
{
    const Value selector = expression(*node.selector)[0];
    std::vector<const Switch::Case*> all; // the default last
    const Switch::Case* otherwise = nullptr;
    Completion either = completion_of(s);
    for (const Switch::Case& one : node.cases) {
        (one.is_default() ? otherwise : all.emplace_back()) = &one;
        either.breaks |= completion_of(up_to_break(one)).breaks;
    }
    if (otherwise) all.push_back(otherwise);
    either.add(completion_of(rest));
    const Slots changed = changed_slots(listed(&s, rest), either);
    const Values broken_before = variables[broken_slot()];
    variables[broken_slot()] = {builder.boolean(false)};
    cases(all, selector, rest, changed);
    variables[broken_slot()] = broken_before;
}

// "if (it is one of the labels of the first) a else (the others)".
void BodyLowering::cases(std::span<const Switch::Case* const> all, Value selector, Statements rest,
                         const Slots& changed)
{
    if (all.empty()) return sequence(rest);
    const Switch::Case& one = *all.front();
    const auto take_case = [&] { take(up_to_break(one), rest, changed); };
    if (one.is_default()) return take_case();
    std::optional<Value> is_here;
    for (const ExpressionPtr& label : one.labels) {
        const Value is_label = binary_scalar(BinaryOp::equal, selector, expression(*label)[0]);
        is_here = is_here ? builder.operation(Op::lor, {*is_here, is_label}) : is_label;
    }
    choose(*is_here, changed, take_case, [&] { cases(all.subspan(1), selector, rest, changed); });
}

// ---- variables

void BodyLowering::lower(const Declaration& node)
{
    if (node.symbol->kind != SymbolKind::local) return; // constants and tables stand where they are used
    variables[node.symbol->slot] =
        node.initializer ? converted(*node.initializer, node.symbol->type) : zeros(node.symbol->type);
}

void BodyLowering::lower(const Assignment& node)
{
    const Expression& target = *node.target;
    Values value = expression(*node.value);
    Type type = node.value->type;
    if (node.op) {
        const Values before = expression(target);
        builder.span = join(target.span, node.value->span);
        value = binary(*node.op, before, target.type, value, type);
        type = operator_types(*node.op, target.type, type)->result;
    }
    value = convert(value, type, target.type);
    store(target, value);
}

// Replaces the part of a variable that `target` names.
void BodyLowering::store(const Expression& target, const Values& value)
{
    if (auto name = std::get_if<NameExpression>(&target.node)) {
        variables[name->symbol->slot] = value;
        return;
    }
    auto member = std::get_if<Member>(&target.node);
    auto index = std::get_if<Index>(&target.node);
    const Expression& object = member ? *member->object : *index->object;
    if (owner.is_too_large(target.span, builder.function().value_types.size())) return; // a choice per element adds up
    Values whole = expression(object);
    if (object.type.is_struct()) {
        std::ranges::copy(value, whole.begin() + object.type.structure->member(member->member.text)->first);
    } else if (member) {
        const Swizzle swizzle = *parse_swizzle(member->member.text);
        for (uint8_t i = 0; i < swizzle.size; ++i) whole[swizzle.component[i]] = value[i];
    } else {
        const Value at = index_within(*index->index, object.type.element_count());
        for (size_t i = 0; i < whole.size(); ++i) {
            const auto element = static_cast<int32_t>(i / value.size());
            const Value is_here = builder.operation(Op::ieq, {at, builder.i32(element)});
            whole[i] = builder.operation(Op::select, {is_here, value[i % value.size()], whole[i]});
        }
    }
    store(object, whole);
}

// ---- loops

void BodyLowering::lower(const For& node)
{
    const LoopPlan& plan = node.plan;
    if (!plan.counter) {
        owner.diagnostics.error(builder.span, "internal-error", "the compiler does not know how often a loop runs");
        return;
    }
    const Type type = plan.counter->type;
    if (type == float_type) {
        const Value start = builder.real(plan.real_start), step = builder.real(plan.real_step);
        const Value trips = builder.i32(static_cast<int32_t>(plan.trip_max));
        return turns(node, trips, [&](Value turn) {
            const Value way = builder.operation(Op::mul, {builder.operation(Op::i_to_r, {turn}), step});
            return builder.operation(Op::add, {start, way});
        });
    }
    const bool up = plan.step > 0;
    const auto stride = static_cast<int32_t>(up ? plan.step : -plan.step);
    const Value start = converted(*plan.start, type)[0], bound = converted(*plan.bound, type)[0];
    builder.span = join(plan.start->span, plan.bound->span);
    const auto as_signed = [&](Value v) { return type == uint_type ? builder.operation(Op::u_as_i, {v}) : v; };

    // bound - start, rounded up to whole strides; the checker has proven that it does not wrap where it matters
    Value trips = as_signed(up ? integer(Op::isub, bound, start) : integer(Op::isub, start, bound));
    trips = builder.operation(Op::iadd, {trips, builder.i32(plan.is_inclusive ? stride : stride - 1)});
    trips = builder.operation(Op::idiv, {trips, builder.i32(stride)});
    if (plan.difference_may_wrap) {
        const Value beyond = binary_scalar(BinaryOp::less, up ? bound : start, up ? start : bound);
        trips = builder.operation(Op::select, {beyond, builder.i32(0), trips});
    }
    turns(node, trips, [&](Value turn) {
        Value offset = builder.operation(Op::imul, {turn, builder.i32(static_cast<int32_t>(plan.step))});
        if (type == uint_type) offset = builder.operation(Op::i_as_u, {offset});
        return integer(Op::iadd, start, offset);
    });
}

// `counter` makes what counts of the number of a turn, from 0.
void BodyLowering::turns(const For& node, Value trips, const std::function<Value(Value turn)>& counter)
{
    const LoopPlan& plan = node.plan;
    Completion ends = node.body ? completion_of(*node.body) : Completion{};
    ends.continues = false; // of concern to its own turn alone
    const Slots changed = node.body ? changed_slots(listed(node.body.get(), {}), ends) : Slots{};
    if (region_depth >= region_max) return choose(builder.boolean(true), {}, [] {}, [] {}); // which reports it
    const Nesting region(region_depth);
    depth = std::max(depth, region_depth);
    const Values broken_before = variables[broken_slot()], turned_before = variables[turned_slot()];
    variables[broken_slot()] = variables[turned_slot()] = {builder.boolean(false)};
    const Values before = gather(changed);
    const Values after =
        builder.for_loop(trips, plan.trip_max, before, [&](Value iteration, std::span<const Value> carried) {
            scatter(changed, carried);
            variables[plan.counter->slot] = {counter(iteration)};
            if (ends.may_leave())
                choose(left(), changed, [] {}, [&] { statement(*node.body, {}); });
            else if (node.body)
                statement(*node.body, {});
            variables[turned_slot()] = {builder.boolean(false)};
            return gather(changed);
        });
    scatter(changed, after);
    variables[broken_slot()] = broken_before;
    variables[turned_slot()] = turned_before;
}

} // namespace haptel::lang
