// Statements: declarations, assignments, branches, and whether every path returns.
#include "lang/check/body_checker.h"
#include "lang/syntax/operators.h"
#include "lang/text/limits.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

void BodyChecker::statements(std::vector<StatementPtr>& list)
{
    bool reported = false;
    for (StatementPtr& s : list) {
        if (!s) continue;
        if (diagnostics.full() || slot_count > variables_max) { // enough is said
            in_damaged_body = true;
            return;
        }
        if (!flow.reachable && !reported && !is_library && !in_damaged_body) {
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
    if (type == image_type) {
        report_image(context, node.type);
        type = Type::error();
    }
    if (type == void_type) {
        diagnostics.error(node.type.base.span, "type-mismatch", "a variable cannot be void",
                          "write float, int, vec3 ...");
        type = Type::error();
    }
    if (node.type.is_array) {
        node.symbol = array(node, type);
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
        symbol.value = context.constants.value(value, type);
        if (type == int_type || type == uint_type) {
            const auto number = static_cast<int64_t>(as_number(symbol.value.front(), type));
            symbol.range = ir::IntRange{number, number};
        }
    } else {
        flow.variables[symbol.slot].assigned = all_parts;
        if (fits) flow.variables[symbol.slot].range = range(value);
    }
}

void BodyChecker::check(Statement& s, Assignment& node)
{
    expression(*node.value);
    const Target target = target_of(*node.target);
    if (!target.symbol) {
        // Whatever was meant has a value now.
        if (auto name = std::get_if<NameExpression>(&node.target->node))
            if (Symbol* local = find_local(name->name); local && local->kind == SymbolKind::local)
                flow.variables[local->slot].assigned = all_parts;
        return;
    }
    target.symbol->is_assigned = true;
    Variable& variable = flow.variables[target.symbol->slot];
    if (!node.op) {
        if (require(*node.value, target.type, " for " + quoted(excerpt(*node.target))))
            variable.range = range(*node.value);
        variable.assigned |= target.parts;
        return;
    }
    const bool was_read = target.symbol->is_read; // "x += 1" alone is no use of x
    if (target.parts & ~variable.assigned) {
        auto name = std::get_if<NameExpression>(&node.target->node);
        if (name)
            read(*node.target, *name, all_parts);
        else
            expression(*node.target);
    }
    target.symbol->is_read = was_read;
    variable.range = ir::full_range(target.type == uint_type ? ir::Type::u32 : ir::Type::i32);
    Type right = node.value->type;
    if (right.is_error()) return;
    if (target.type == uint_type && right == int_type && std::holds_alternative<NumberLiteral>(node.value->node))
        right = node.value->type = uint_type;
    const auto types = operator_types(*node.op, target.type, right);
    if (!types) {
        report_operator(*node.op, s.span, target.type, *node.value);
    } else if (types->result != target.type) {
        diagnostics.error(node.value->span, "type-mismatch",
                          std::string(describe(operator_of(*node.op).assignment)) + " would make " +
                              quoted(excerpt(*node.target)) + " a " + to_string(types->result) + ", expected " +
                              to_string(target.type),
                          !types->result.is_scalar() ? "declare it as " + to_string(types->result)
                                                     : "write " + to_string(target.type) + "(...) round the value");
    }
}

void BodyChecker::check(Statement& s, ExpressionStatement& node)
{
    if (expression(*node.expression).is_error() || in_damaged_body) return;
    diagnostics.warning(s.span, "useless-statement",
                        "this value is not used: functions only return values, they change nothing",
                        "assign it to a variable or leave it out");
}

void BodyChecker::condition(ExpressionPtr& e, const char* of_what)
{
    if (!e || expression(*e).is_error() || e->type == bool_type) return;
    Diagnostic& reported = diagnostics.error(e->span, "type-mismatch",
                                             std::string("expected bool ") + of_what + ", found " + to_string(e->type));
    if (e->type == float_type) reported.hint = "compare: " + operand(*e) + " != 0.0";
    if (e->type == int_type || e->type == uint_type) reported.hint = "compare: " + operand(*e) + " != 0";
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
    Flow after{{}, false};
    for (If::Arm& arm : node.arms) {
        condition(arm.condition, "after 'if'");
        const Flow before = flow;
        if (arm.body) body(*arm.body);
        merge(after, flow);
        flow = before;
    }
    if (node.arms.back().condition) merge(after, flow); // no else
    if (after.reachable)
        flow = std::move(after);
    else
        flow.reachable = false;
}

void BodyChecker::check(Statement& s, Break&)
{
    flow.reachable = false;
    if (loop_depth > 0 || in_damaged_body) return;
    diagnostics.error(s.span, "misplaced-break", "'break' leaves a loop, and there is none round it");
    in_damaged_body = true; // what follows is reached, if it is left out
}

void BodyChecker::check(Statement& s, Return& node)
{
    if (!node.value) {
        if (!result_type.is_error()) // of what returns nothing, enough has been said
            diagnostics.error(s.span, "missing-value", "expected a " + to_string(result_type) + " behind 'return'");
    } else {
        expression(*node.value);
        require(*node.value, result_type, " from " + quoted(owner_name));
    }
    flow.reachable = false;
}

} // namespace haptel::lang
