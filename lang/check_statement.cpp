// Statements: declarations, assignments, branches, and whether every path returns.
#include "lang/body_checker.h"
#include "lang/constant.h"
#include "lang/operators.h"
#include "lang/swizzle.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

constexpr uint32_t table_size_max = 65'536;

} // namespace

void BodyChecker::statements(std::vector<StatementPtr>& list)
{
    bool reported = false;
    for (StatementPtr& s : list) {
        if (!s) continue;
        if (!flow.reachable && !reported && !is_library) {
            diagnostics.warning(s->span, "unreachable-code", "this is never reached");
            reported = true;
        }
        statement(*s);
    }
}

void BodyChecker::statement(Statement& s)
{
    std::visit([&](auto& node) { check(s, node); }, s.node);
}

void BodyChecker::body(Statement& s)
{
    open_scope();
    statement(s);
    close_scope();
}

void BodyChecker::check(Statement&, ast::Scope& node)
{
    open_scope();
    statements(node.statements);
    close_scope();
}

void BodyChecker::check(Statement&, Declaration& node)
{
    Type type = resolve_type(context, node.type);
    if (type == void_type) {
        diagnostics.error(node.type.base.span, "type-mismatch", "a variable cannot be void").hint =
            "write float, int, vec3 ...";
        type = Type::error();
    }
    if (node.type.is_array) {
        node.symbol = table(node, type);
        return;
    }
    if (!node.initializer) {
        Symbol& symbol = declare(node.name, SymbolKind::local, type);
        if (node.is_const) {
            diagnostics.error(node.name.span, "missing-value",
                              "constant " + quoted(node.name.text) + " has no value, expected '='");
            symbol.type = Type::error();
        }
        node.symbol = &symbol;
        return;
    }
    Expression& value = *node.initializer;
    const uint32_t reports = diagnostics.reports();
    expression(value);
    const bool fits = require(value, type, " for " + quoted(node.name.text));
    const bool is_sound = fits && diagnostics.reports() == reports;
    const bool is_constant = node.is_const && is_sound && !first_not_constant(value);
    Symbol& symbol = declare(node.name, is_constant ? SymbolKind::constant : SymbolKind::local, type);
    node.symbol = &symbol;
    symbol.is_read = !is_sound; // that it is not used is then not worth saying
    if (node.is_const) symbol.read_only = "it is constant";
    if (is_constant) {
        symbol.value = evaluate_constant(value, type);
        if (type == int_type || type == uint_type) {
            const auto number = static_cast<int64_t>(as_number(symbol.value.front(), type));
            symbol.range = ir::IntRange{number, number};
        }
    } else {
        flow.variables[symbol.slot].assigned = 0xff;
        if (fits) flow.variables[symbol.slot].range = range(value);
    }
}

// const float A[3] = {1.0, 2.0, 3.0};
Symbol* BodyChecker::table(Declaration& node, Type element)
{
    auto list = node.initializer ? std::get_if<BraceList>(&node.initializer->node) : nullptr;
    if (!node.is_const || (node.initializer && !list && !node.initializer->type.is_error())) {
        if (node.initializer && !list) expression(*node.initializer);
        diagnostics
            .error(node.name.span, "not-constant",
                   "an array is a constant table, expected 'const " + node.type.base.text + " " + node.name.text +
                       "[...] = {...};'")
            .hint = "what changes belongs into variables";
        element = Type::error();
    } else if (!list) {
        diagnostics.error(node.name.span, "missing-value",
                          "table " + quoted(node.name.text) + " has no values, expected '= {...}'");
        element = Type::error();
    }
    if (element == bool_type) {
        diagnostics.error(node.type.base.span, "type-mismatch", "a table holds numbers, found bool").hint =
            "write int A[] = {0, 1}; and compare, A[i] != 0";
        element = Type::error();
    }
    size_t count = list ? list->elements.size() : 0;
    if (node.type.array_size && !element.is_error()) {
        Expression& size = *node.type.array_size;
        const Type found = expression(size);
        const bool is_int = found == int_type || found == uint_type;
        const ir::IntRange wanted = range(size);
        if (!found.is_error() && !(is_int && wanted.is_constant())) {
            diagnostics.error(size.span, "not-constant",
                              "expected a constant int as the size of a table, found " +
                                  (is_int ? std::string("one that varies") : to_string(found)));
        } else if (!found.is_error() && wanted.minimum != static_cast<int64_t>(count)) {
            diagnostics
                .error(size.span, "table-size",
                       quoted(node.name.text) + " is declared with " + std::to_string(wanted.minimum) +
                           " elements and has " + std::to_string(count))
                .hint = "leave the size out, " + node.name.text + "[], and it is counted";
        }
    }
    if (!element.is_error() && (count == 0 || count > table_size_max)) {
        diagnostics.error(node.initializer->span, "table-size",
                          "expected 1 .. " + std::to_string(table_size_max) + " elements, found " +
                              std::to_string(count));
        element = Type::error();
    }
    std::vector<ConstantPart> value;
    bool is_sound = true; // of no type after an error: nothing more is said about it
    for (size_t i = 0; list && i < count; ++i) {
        Expression& cell = *list->elements[i];
        const uint32_t reports = diagnostics.reports();
        expression(cell);
        const bool fits = require(cell, element, " for an element of " + quoted(node.name.text));
        if (!fits || diagnostics.reports() != reports) {
            is_sound = false;
        } else if (const Expression* culprit = first_not_constant(cell)) {
            is_sound = false;
            diagnostics.error(culprit->span, "not-constant",
                              "a table is constant, expected a value known when the texture is compiled");
        } else {
            const auto parts = evaluate_constant(cell, element);
            value.insert(value.end(), parts.begin(), parts.end());
        }
    }
    if (!is_sound) element = Type::error();
    Type type = element;
    if (!type.is_error()) type.array_size = static_cast<uint32_t>(count);
    Symbol& symbol = declare(node.name, SymbolKind::table, type);
    symbol.read_only = "it is a constant table";
    symbol.value = std::move(value);
    return &symbol;
}

BodyChecker::Target BodyChecker::target_of(Expression& e)
{
    Expression* object = &e;
    const auto member = std::get_if<Member>(&e.node);
    const auto index = std::get_if<Index>(&e.node);
    if (member) object = member->object.get();
    if (index) object = index->object.get();
    auto name = std::get_if<NameExpression>(&object->node);
    if (!name) {
        if (!std::holds_alternative<ErrorExpression>(object->node))
            diagnostics.error(e.span, "not-assignable", "expected a variable or components of one before '='").hint =
                "v.xy and v[1] are such components, v.xyz.x is not";
        return {};
    }
    Symbol* local = find_local(name->name);
    const Symbol* symbol = find(name->name);
    if (!symbol) {
        expression(*object); // says what the name is, if anything
        return {};
    }
    name->symbol = symbol;
    object->type = symbol->type;
    if (symbol->type.is_error()) return {};
    if (symbol->read_only || !local || symbol->kind == SymbolKind::function) {
        Diagnostic& reported = diagnostics.error(
            e.span, "read-only",
            quoted(name->name) + " cannot be changed: " + (symbol->read_only ? symbol->read_only : "it is a function"));
        if (symbol->kind == SymbolKind::input || symbol->kind == SymbolKind::texture_parameter)
            reported.hint = "change a copy: " + to_string(symbol->type) + " " + (symbol->name == "q" ? "r" : "q") +
                            " = " + symbol->name + ";";
        if (symbol->span.end > 0) reported.related.push_back({symbol->span, quoted(name->name) + " is declared here"});
        return {};
    }
    Target target{local, static_cast<uint8_t>((1u << symbol->type.size) - 1), symbol->type};
    if (member) {
        const auto swizzle = parse_swizzle(member->member.text);
        if (!symbol->type.is_vector() || !swizzle || swizzle->highest() >= symbol->type.size) {
            flow.variables[local->slot].assigned = 0xff;
            expression(e); // says what is wrong with it
            return {};
        }
        if (swizzle->has_repeats()) {
            diagnostics.error(member->member.span, "bad-swizzle",
                              "a component stands twice in " + quoted(member->member.text) +
                                  ", expected each once in a target");
            return {};
        }
        target.components = swizzle->mask();
        target.type = vec(swizzle->size);
    } else if (index) {
        const uint8_t before = flow.variables[local->slot].assigned;
        flow.variables[local->slot].assigned = 0xff; // what is not picked is not read
        expression(e);
        flow.variables[local->slot].assigned = before;
        if (e.type.is_error() || index->index->type.is_error()) return {};
        const ir::IntRange at = range(*index->index);
        target.components = at.is_constant() ? static_cast<uint8_t>(1u << (at.minimum & 3)) : 0;
        target.type = float_type;
    }
    e.type = target.type;
    return target;
}

void BodyChecker::check(Statement& s, Assignment& node)
{
    expression(*node.value);
    const Target target = target_of(*node.target);
    if (!target.symbol) {
        // Whatever was meant has a value now.
        if (auto name = std::get_if<NameExpression>(&node.target->node))
            if (Symbol* local = find_local(name->name); local && local->kind == SymbolKind::local)
                flow.variables[local->slot].assigned = 0xff;
        return;
    }
    target.symbol->is_assigned = true;
    Variable& variable = flow.variables[target.symbol->slot];
    const auto operation = operation_of(node.op);
    if (!operation) {
        if (require(*node.value, target.type, " for " + quoted(excerpt(*node.target))))
            variable.range = range(*node.value);
        variable.assigned |= target.components;
        return;
    }
    const bool was_read = target.symbol->is_read; // "x += 1" alone is no use of x
    if (target.components & ~variable.assigned) {
        auto name = std::get_if<NameExpression>(&node.target->node);
        if (name)
            read(*node.target, *name, 0xff);
        else
            expression(*node.target);
    }
    target.symbol->is_read = was_read;
    variable.range = ir::full_range(target.type == uint_type ? ir::Type::u32 : ir::Type::i32);
    Type right = node.value->type;
    if (right.is_error()) return;
    if (target.type == uint_type && right == int_type && std::holds_alternative<NumberLiteral>(node.value->node))
        right = node.value->type = uint_type;
    const auto types = operator_types(*operation, target.type, right);
    if (!types) {
        report_operator(*operation, s.span, target.type, *node.value);
    } else if (types->result != target.type) {
        diagnostics
            .error(node.value->span, "type-mismatch",
                   quoted(spelling(node.op)) + " would make " + quoted(excerpt(*node.target)) + " a " +
                       to_string(types->result) + ", expected " + to_string(target.type))
            .hint = types->result.is_vector() ? "declare it as " + to_string(types->result)
                                              : "write " + to_string(target.type) + "(...) round the value";
    }
}

void BodyChecker::check(Statement& s, ExpressionStatement& node)
{
    if (expression(*node.expression).is_error()) return;
    diagnostics
        .warning(s.span, "useless-statement",
                 "this value is not used: functions only return values, they change nothing")
        .hint = "assign it to a variable or leave it out";
}

void BodyChecker::condition(ExpressionPtr& e, const char* of_what)
{
    if (!e || expression(*e).is_error() || e->type == bool_type) return;
    Diagnostic& reported = diagnostics.error(e->span, "type-mismatch",
                                             std::string("expected bool ") + of_what + ", found " + to_string(e->type));
    if (e->type == float_type) reported.hint = "compare: " + excerpt(*e) + " != 0.0";
    if (e->type == int_type || e->type == uint_type) reported.hint = "compare: " + excerpt(*e) + " != 0";
}

// What holds on either of two paths; a path that does not go on has no say.
void BodyChecker::merge(Flow& into, const Flow& other) const
{
    if (!other.reachable) return;
    if (!into.reachable) {
        into = other;
        return;
    }
    for (size_t i = 0; i < std::min(into.variables.size(), other.variables.size()); ++i) {
        into.variables[i].assigned &= other.variables[i].assigned;
        into.variables[i].range = ir::join(into.variables[i].range, other.variables[i].range);
    }
}

void BodyChecker::check(Statement&, If& node)
{
    Flow after;
    after.reachable = false;
    size_t slots = flow.variables.size(); // slots are never used twice, so flows may differ in length
    bool has_else = false;
    const bool was_reachable = flow.reachable;
    for (If::Arm& arm : node.arms) {
        if (arm.condition)
            condition(arm.condition, "after 'if'");
        else
            has_else = true;
        flow.variables.resize(std::max(slots, flow.variables.size()));
        Flow before = flow;
        if (arm.body) body(*arm.body);
        slots = flow.variables.size();
        merge(after, flow);
        flow = std::move(before);
        flow.variables.resize(slots);
    }
    if (!has_else) merge(after, flow);
    if (after.reachable)
        flow = std::move(after);
    else
        flow.reachable = false;
    flow.variables.resize(slots);
    if (!was_reachable) flow.reachable = false;
}

void BodyChecker::check(Statement& s, Break&)
{
    if (loop_depth == 0)
        diagnostics.error(s.span, "misplaced-break", "'break' leaves a loop, and there is none round it");
    flow.reachable = false;
}

void BodyChecker::check(Statement& s, Return& node)
{
    if (!node.value) {
        diagnostics.error(s.span, "missing-value", "expected a " + to_string(result_type) + " behind 'return'");
    } else {
        expression(*node.value);
        require(*node.value, result_type, " from " + quoted(owner_name));
    }
    flow.reachable = false;
}

} // namespace haptel::lang
