// Dimensions of variables along the paths through a body.
#include "lang/check/dimension/dimension_checker.h"
#include "lang/syntax/operators.h"
#include "lang/syntax/swizzle.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

// A pass over a body carries what a loop learns about a variable that was 0 to the loop's start; each pass may reveal
// more to the next. What more passes would find is given up.
constexpr int passes_max = 16;

} // namespace

DimensionBody::DimensionBody(DimensionChecker& all, DimensionInstance& made, bool in_library)
    : owner(all), instance(made), is_library(in_library)
{
}

void DimensionBody::function(const FunctionInfo& info, const FunctionReferences& passed, const Dimensions& arguments)
{
    functions = passed;
    Variables parameters;
    for (const Dimension dimension : arguments)
        parameters.push_back({dimension, info.tree->name.span, Dimension::any(), {}});
    if (info.tree->body) body(*info.tree->body, info.slot_count, parameters);
}

void DimensionBody::texture(const CheckedTexture& texture)
{
    outputs = &texture.outputs;
    Variables start(texture.slot_count);
    for (const CheckedOutput& output : texture.outputs)
        start[output.symbol->slot] = {Dimension::plain(), output.symbol->span, Dimension::any(), {}};
    for (const CheckedParameter& parameter : texture.parameters)
        owner.symbols.insert_or_assign(parameter.symbol, this->parameter(parameter));
    const auto in_parameters = std::move(instance.findings);
    if (texture.tree->body) body(*texture.tree->body, texture.slot_count, start);
    instance.findings.insert(instance.findings.end(), in_parameters.begin(), in_parameters.end());
}

Dimension DimensionBody::constant(const Declaration& declaration)
{
    return declaration.initializer ? expression(*declaration.initializer) : Dimension::any();
}

// That of its default; a default of 0 says nothing, then its range does.
Dimension DimensionBody::parameter(const CheckedParameter& parameter)
{
    const TextureParameter& tree = *parameter.tree;
    Dimension dimension = Dimension::any();
    for (const Expression* e : {tree.value.get(), tree.minimum.get(), tree.maximum.get()}) {
        if (!e) continue;
        const Dimension found = expression(*e);
        const auto both = join(dimension, found);
        if (!both)
            report_expected("the range of '" + tree.name.text + "' must be", *e, dimension, found,
                            " as its default is");
        dimension = both.value_or(dimension);
    }
    return dimension.is_any() ? Dimension::plain() : dimension;
}

void DimensionBody::body(const Statement& tree, uint32_t slot_count, const Variables& parameters)
{
    for (int pass = 0; pass < passes_max; ++pass) {
        instance.findings.clear();
        instance.callees.clear();
        instance.is_at_fault = false;
        instance.result = Dimension::any();
        has_returned = false;
        heads_changed = false;
        flow = {};
        flow.variables = parameters;
        flow.variables.resize(slot_count);
        statement(tree);
        if (!heads_changed) return;
    }
}

void DimensionBody::statement(const Statement& s)
{
    if (!flow.reachable || owner.nesting >= dimension_nesting_limit) return;
    ++owner.nesting;
    std::visit([&](const auto& node) { walk(s, node); }, s.node);
    --owner.nesting;
}

void DimensionBody::walk(const Statement&, const ast::Scope& node)
{
    for (const StatementPtr& inner : node.statements)
        if (inner) statement(*inner);
}

void DimensionBody::walk(const Statement&, const ExpressionStatement& node)
{
    expression(*node.expression);
}

void DimensionBody::walk(const Statement&, const Declaration& node)
{
    const Dimension dimension = constant(node);
    if (!node.symbol) return;
    if (node.symbol->kind == SymbolKind::local)
        flow.variables[node.symbol->slot] = {
            dimension, node.initializer ? node.initializer->span : node.name.span, Dimension::any(), {}};
    else
        owner.symbols.insert_or_assign(node.symbol, dimension);
}

void DimensionBody::walk(const Statement& s, const Assignment& node)
{
    const Expression* object = node.target.get();
    uint32_t components = 0; // of a vector that is assigned in part
    if (auto member = std::get_if<Member>(&object->node)) {
        object = member->object.get();
        if (const auto swizzle = parse_swizzle(member->member.text)) components = swizzle->mask();
    }
    while (auto index = std::get_if<Index>(&object->node)) {
        expression(*index->index);
        object = index->object.get();
        components = 0;
    }
    Dimension value = expression(*node.value);
    auto name = std::get_if<NameExpression>(&object->node);
    if (!name || !name->symbol || name->symbol->kind != SymbolKind::local) return;
    if (const auto operation = operation_of(node.op))
        value = binary(*operation, find(*object, *name), value, s.span, nullptr, *node.value);
    Variable& variable = flow.variables[name->symbol->slot];
    const bool is_whole = object == node.target.get() || components == (1u << name->symbol->type.size) - 1;
    if (is_whole) {
        variable = {value, node.value->span, Dimension::any(), {}};
        return;
    }
    const Type type = name->symbol->type;
    const std::string what = type.is_array() ? "an array" : type.is_matrix() ? "a matrix" : "a vector";
    const Dimension before = find(*object, *name);
    const auto both = join(before, value);
    if (!both)
        if (auto finding = report(node.value->span, what + " has one dimension: '" + name->name + "' is " +
                                                        description(before) + ", got " + description(value)))
            propose(*finding, *node.value, before, value);
    if (before.is_any()) variable = {value, node.value->span, Dimension::any(), {}};
}

// Variables are what they are on all paths; where paths differ, that is reported when such a variable is read.
void DimensionBody::merge(Flow& into, const Flow& other) const
{
    if (!other.reachable) return;
    if (!into.reachable) {
        into = other;
        return;
    }
    for (size_t i = 0; i < into.variables.size(); ++i) {
        Variable& variable = into.variables[i];
        const Variable& there = other.variables[i];
        if (variable.is_mixed() || (there.dimension.is_any() && !there.is_mixed())) continue;
        if (variable.dimension.is_any() || there.is_mixed()) {
            variable = there;
        } else if (variable.dimension != there.dimension) {
            variable.other = there.dimension;
            variable.other_set = there.set;
        }
    }
}

void DimensionBody::walk(const Statement&, const If& node)
{
    Flow after;
    after.reachable = false;
    bool has_else = false;
    for (const If::Arm& arm : node.arms) {
        if (!owner.spend(flow.variables.size())) return;
        if (arm.condition)
            expression(*arm.condition);
        else
            has_else = true;
        const Flow before = flow;
        if (arm.body) statement(*arm.body);
        merge(after, flow);
        flow = before;
    }
    if (!has_else) merge(after, flow);
    if (after.reachable)
        flow = std::move(after);
    else
        flow.reachable = false;
}

void DimensionBody::walk(const Statement&, const For& node)
{
    if (node.init) statement(*node.init);
    if (!owner.spend(flow.variables.size())) return;
    Variables& learnt = heads[&node];
    learnt.resize(flow.variables.size());
    for (size_t i = 0; i < learnt.size(); ++i)
        if (flow.variables[i].dimension.is_any() && !flow.variables[i].is_mixed()) flow.variables[i] = learnt[i];
    Flow at_head = flow;
    Flow exit;
    exit.reachable = false;
    loop_exits.push_back(&exit);
    if (node.condition) expression(*node.condition);
    if (node.body) statement(*node.body);
    if (node.step) statement(*node.step);
    loop_exits.pop_back();
    settle(node, at_head.variables);
    Flow after = at_head;
    merge(after, flow);
    merge(after, exit);
    flow = std::move(after);
}

// What comes round to the start of the loop again must be what it was there.
void DimensionBody::settle(const For& loop, Variables& at_head)
{
    if (!flow.reachable) return;
    for (size_t i = 0; i < at_head.size(); ++i) {
        Variable& end = flow.variables[i];
        Variable& start = at_head[i];
        if (start.is_mixed() || (end.dimension.is_any() && !end.is_mixed())) continue;
        if (start.dimension.is_any()) {
            heads[&loop][i] = {end.dimension, end.set, Dimension::any(), {}};
            heads_changed = true;
            continue;
        }
        const bool other_differs = end.is_mixed() && end.other != start.dimension;
        if (end.dimension == start.dimension && !other_differs) continue;
        const bool first_differs = end.dimension != start.dimension;
        if (auto finding = report(first_differs ? end.set : end.other_set,
                                  "a loop may not change the dimension of a variable: it is " +
                                      description(start.dimension) + " where a turn begins and becomes " +
                                      description(first_differs ? end.dimension : end.other) + " here")) {
            finding->hint = "keep what changes in a variable of its own inside the loop";
            finding->related.push_back({start.set, "here it gets the dimension it begins with"});
        }
        end.dimension = start.dimension = Dimension::any(); // what follows is not blamed for it
    }
}

void DimensionBody::walk(const Statement&, const Break&)
{
    if (!loop_exits.empty()) merge(*loop_exits.back(), flow);
    flow.reachable = false;
}

// Scales of the material are plain numbers, whatever they were on the way.
void DimensionBody::check_outputs()
{
    for (const CheckedOutput& output : *outputs) {
        Variable& variable = flow.variables[output.symbol->slot];
        const bool is_wrong = !join(variable.dimension, Dimension::plain()) || variable.is_mixed();
        const bool other_is_wrong = join(variable.dimension, Dimension::plain()).has_value();
        if (!is_wrong) continue;
        report(other_is_wrong ? variable.other_set : variable.set,
               "output '" + output.symbol->name + "' is a plain number, got " +
                   description(other_is_wrong ? variable.other : variable.dimension));
        variable = {};
    }
}

void DimensionBody::walk(const Statement&, const Return& node)
{
    flow.reachable = flow.reachable && !node.value;
    if (!node.value) return;
    const Dimension found = expression(*node.value);
    if (outputs) {
        check_outputs();
        if (!join(found, Dimension::length())) {
            const std::string advice = found.is_plain() ? ": multiply by a depth" : "";
            auto finding = report(node.value->span, "a texture returns a length, got " + description(found) + advice);
            if (finding && found.is_plain()) finding->hint = "for example 50um * (...)";
        }
    } else if (const auto both = join(instance.result, found)) {
        if (instance.result.is_any()) returned_at = node.value->span;
        instance.result = *both;
    } else if (auto finding =
                   report(node.value->span, "every 'return' of a function must have one dimension, found " +
                                                description(instance.result) + " and " + description(found))) {
        finding->related.push_back({returned_at, "here it is " + description(instance.result)});
        propose(*finding, *node.value, instance.result, found);
    }
    flow.reachable = false;
}

} // namespace haptel::lang
