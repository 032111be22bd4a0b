// Dimensions of variables along the paths through a body.
#include "lang/check/dimension/dimension_checker.h"
#include "lang/syntax/operators.h"
#include "lang/syntax/swizzle.h"

#include <algorithm>
#include <iterator>

namespace haptel::lang {

using namespace ast;

namespace {

// A pass over a body carries what a loop learns about a variable that was 0 to the loop's start; each pass may reveal
// more to the next. What more passes would find is given up.
constexpr int passes_max = 16;

} // namespace

void DimensionBody::function(const FunctionInfo& info, const PassedFunctions& passed, const Dimensions& arguments)
{
    functions = passed;
    info_of = &info;
    Variables start;
    for (const Dimension dimension : arguments) start.push_back({{dimension, info.tree->name.span}});
    start.resize(info.slot_count);
    body(*info.tree->body, start);
}

void DimensionBody::texture(const CheckedTexture& texture)
{
    outputs = &texture.outputs;
    Variables start(texture.slot_count);
    for (const CheckedOutput& output : texture.outputs)
        start[output.symbol->slot] = {
            {output.info->is_never_negative ? dimension_of_unit(output.info->unit) : Dimension::any(),
             output.symbol->span}};
    for (const CheckedParameter& parameter : texture.parameters)
        owner.symbols.insert_or_assign(parameter.symbol, this->parameter(parameter));
    body(*texture.tree->body, start);
}

void DimensionBody::body(const Statement& tree, const Variables& start)
{
    const auto found_before = std::ssize(instance.findings);
    heads_changed = true;
    for (int pass = 0; pass < passes_max && heads_changed; ++pass) {
        instance.findings.erase(instance.findings.begin() + found_before, instance.findings.end());
        instance.callees.clear();
        instance.is_at_fault = heads_changed = false;
        instance.result = Dimension::any();
        instance.written.clear();
        flow = start;
        statement(tree);
        if (flow && info_of) collect_written(tree.span);
    }
}

void DimensionBody::statement(const Statement& s)
{
    if (!flow || owner.nesting >= dimension_nesting_limit) return;
    ++owner.nesting;
    if (auto block = std::get_if<ast::Scope>(&s.node)) {
        for (const StatementPtr& inner : block->statements)
            if (inner) statement(*inner);
    } else if (auto evaluated = std::get_if<ExpressionStatement>(&s.node)) {
        expression(*evaluated->expression);
    } else if (auto declared = std::get_if<Declaration>(&s.node)) {
        declaration(*declared);
    } else if (auto assignment = std::get_if<Assignment>(&s.node)) {
        assign(s, *assignment);
    } else if (auto choice = std::get_if<If>(&s.node)) {
        branch(*choice);
    } else if (auto chosen = std::get_if<Switch>(&s.node)) {
        this->choice(*chosen);
    } else if (auto repeated = std::get_if<For>(&s.node)) {
        loop(*repeated);
    } else if (auto left = std::get_if<Return>(&s.node)) {
        leave(*left, s.span);
        flow.reset();
    } else {
        const bool ends_turn = std::holds_alternative<Continue>(s.node); // else the loop or switch
        merge(*(ends_turn ? loop_turns : loop_exits).back(), flow);
        flow.reset();
    }
    --owner.nesting;
}

void DimensionBody::declaration(const Declaration& node)
{
    const Dimension found = node.initializer ? expression(*node.initializer) : Dimension::any();
    if (node.symbol->kind == SymbolKind::local)
        (*flow)[node.symbol->slot] = {{found, node.initializer ? node.initializer->span : node.name.span}};
    else
        owner.symbols.insert_or_assign(node.symbol, found);
}

void DimensionBody::assign(const Statement& s, const Assignment& node)
{
    Dimension value = expression(*node.value);
    if (node.op) {
        const NameExpression& name = *root_of(*node.target);
        value = binary(*node.op, read(*name.symbol, node.target->span), value, s.span, nullptr, *node.value);
    }
    give(*node.target, value, *node.value);
}

// `whence` for messages.
void DimensionBody::give(const Expression& target, Dimension value, const Expression& whence)
{
    const Expression* object = &target;
    uint32_t components = 0; // of a vector that is assigned in part
    for (; const Expression* whole = whole_of(*object); object = whole) {
        auto member = std::get_if<Member>(&object->node);
        if (auto index = std::get_if<Index>(&object->node)) expression(*index->index);
        components = member && whole->type.is_vector() ? parse_swizzle(member->member.text)->mask() : 0;
    }
    const Symbol& symbol = *std::get<NameExpression>(object->node).symbol;
    if (symbol.type.structure) return; // each member has a dimension of its own, which nobody asks for
    Variable& variable = (*flow)[symbol.slot];
    const bool is_whole = object == &target || components == (1u << symbol.type.size) - 1;
    const Dimension before = is_whole ? Dimension::any() : read(symbol, object->span);
    if (before.is_any()) {
        variable = {{value, whence.span}};
    } else if (!join(before, value)) {
        report(whence.span,
               described(symbol.type) + " has one dimension: '" + symbol.name + "' is " + description(before) +
                   ", got " + description(value),
               proposal(whence, before, value));
    }
}

// What a function's outputs are where it ends; one on all paths.
void DimensionBody::collect_written(Span where)
{
    size_t next = 0;
    for (const ParameterInfo& parameter : info_of->parameters) {
        if (!parameter.is_written()) continue;
        if (next == instance.written.size()) instance.written.push_back(Dimension::any());
        Dimension& known = instance.written[next++];
        if (!parameter.symbol) continue;
        const Dimension found = read(*parameter.symbol, where);
        if (const auto both = join(known, found))
            known = *both;
        else
            report(where, "'" + parameter.name + "' must have one dimension wherever its function ends, found " +
                              description(known) + " and " + description(found));
    }
}

// Variables are what they are on all paths; where paths differ, that is reported when such a variable is read.
void DimensionBody::merge(Flow& into, const Flow& other)
{
    if (!into) into = other;
    if (!other) return;
    for (size_t i = 0; i < into->size(); ++i) {
        Variable& here = (*into)[i];
        const Variable& there = (*other)[i];
        if (here.is_mixed() || there.first.dimension.is_any()) continue;
        if (here.first.dimension.is_any() || there.is_mixed())
            here = there;
        else if (here.first.dimension != there.first.dimension)
            here.other = there.first;
    }
}

void DimensionBody::branch(const If& node)
{
    Flow after;
    for (const If::Arm& arm : node.arms) {
        if (!owner.spend(flow->size())) return;
        if (arm.condition) expression(*arm.condition);
        const Flow before = flow;
        if (arm.body) statement(*arm.body);
        merge(after, flow);
        flow = before;
    }
    if (node.arms.back().condition) merge(after, flow); // no else
    flow = std::move(after);
}

void DimensionBody::choice(const Switch& node)
{
    expression(*node.selector);
    Flow after;
    bool has_default = false;
    loop_exits.push_back(&after);
    for (const Switch::Case& one : node.cases) {
        if (!owner.spend(flow->size())) break;
        has_default |= one.is_default();
        const Flow before = flow;
        statement(*one.body);
        merge(after, flow);
        flow = before;
    }
    loop_exits.pop_back();
    if (!has_default) merge(after, flow);
    flow = std::move(after);
}

void DimensionBody::loop(const For& node)
{
    if (node.init) statement(*node.init);
    if (!owner.spend(flow->size())) return;
    Variables& learnt = heads[&node];
    learnt.resize(flow->size());
    for (size_t i = 0; i < learnt.size(); ++i)
        if ((*flow)[i].first.dimension.is_any()) (*flow)[i] = learnt[i];
    Flow after = flow, exit, turn;
    loop_exits.push_back(&exit);
    loop_turns.push_back(&turn);
    if (node.condition) expression(*node.condition);
    if (node.body) statement(*node.body);
    loop_exits.pop_back();
    loop_turns.pop_back();
    merge(flow, turn);
    if (node.step) statement(*node.step);
    if (flow) settle(learnt, *after);
    merge(after, flow);
    merge(after, exit);
    flow = std::move(after);
}

// What comes round to the start of the loop again must be what it was there.
void DimensionBody::settle(Variables& learnt, Variables& at_head)
{
    for (size_t i = 0; i < at_head.size(); ++i) {
        Variable &end = (*flow)[i], &start = at_head[i];
        const Dimension expected = start.first.dimension;
        if (start.is_mixed() || end.first.dimension.is_any()) continue;
        if (expected.is_any()) {
            learnt[i] = {end.first};
            heads_changed = true;
            continue;
        }
        const Origin& changed = end.is_mixed() && end.first.dimension == expected ? end.other : end.first;
        if (changed.dimension == expected) continue;
        report(changed.span,
               "a loop may not change the dimension of a variable: it is " + description(expected) +
                   " where a turn begins and becomes " + description(changed.dimension) + " here",
               {"keep what changes in a variable of its own inside the loop"},
               {{start.first.span, "here it gets the dimension it begins with"}});
        end = start = {}; // what follows is not blamed for it
    }
}

// What they were on the way is as it may be.
void DimensionBody::check_outputs()
{
    for (const CheckedOutput& output : *outputs) {
        if (!output.info->is_never_negative) continue; // of a direction the length means nothing
        Variable& variable = (*flow)[output.symbol->slot];
        const Dimension wanted = dimension_of_unit(output.info->unit);
        const Origin& wrong = join(variable.first.dimension, wanted) ? variable.other : variable.first;
        if (wrong.dimension.is_any()) continue;
        report(wrong.span, "output '" + output.symbol->name + "' is " + description(wanted) + ", got " +
                               description(wrong.dimension));
        variable = {};
    }
}

// "depth" of "depth * sin(q)", if the parameter is a plain number: its default may lack a unit. Null: none.
static const Symbol* plain_factor(const Expression& e, const auto& dimension_of)
{
    if (const auto* name = std::get_if<NameExpression>(&e.node)) {
        const Symbol* symbol = name->symbol;
        const bool is_parameter = symbol && symbol->kind == SymbolKind::texture_parameter && symbol->type == float_type;
        return is_parameter && dimension_of(*symbol).is_plain() ? symbol : nullptr;
    }
    const auto* product = std::get_if<Chain>(&e.node);
    if (!product || product->rest.front().op != BinaryOp::multiply) return nullptr;
    const Symbol* found = plain_factor(*product->first, dimension_of);
    for (const Chain::Link& link : product->rest)
        if (!found && link.op == BinaryOp::multiply) found = plain_factor(*link.operand, dimension_of);
    return found;
}

void DimensionBody::leave(const Return& node, Span where)
{
    const Dimension found = node.value ? expression(*node.value) : Dimension::any();
    if (info_of) collect_written(node.value ? node.value->span : where);
    if (!node.value) return;
    Dimension& result = instance.result;
    if (outputs) {
        check_outputs();
        if (join(found, Dimension::length())) return;
        const Symbol* factor =
            found.is_plain()
                ? plain_factor(*node.value, [&](const Symbol& symbol) { return read(symbol, node.value->span); })
                : nullptr;
        const std::string advice = !found.is_plain() ? ""
                                   : factor          ? ": give '" + factor->name + "' the unit that is meant"
                                                     : ": multiply by a depth";
        report(node.value->span, "a texture returns a length, got " + description(found) + advice,
               {!found.is_plain() ? ""
                : factor          ? "for example float " + factor->name + " = 50um in 0um .. 100um"
                                  : "for example 50um * (...)"});
    } else if (const auto both = join(result, found)) {
        if (result.is_any()) returned_at = node.value->span;
        result = *both;
    } else {
        report(node.value->span,
               "every 'return' of a function must have one dimension, found " + description(result) + " and " +
                   description(found),
               proposal(*node.value, result, found), {{returned_at, "here it is " + description(result)}});
    }
}

} // namespace haptel::lang
