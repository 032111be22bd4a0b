// Statements: declarations, assignments, branches, and whether every path returns.
#include "lang/check/body_checker.h"
#include "lang/check/type_hint.h"
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
        if (!flow.reachable && !reported && !context.is_library && !in_damaged_body) {
            diagnostics.warning(s->span, "unreachable-code", "this is never reached");
            reported = true;
        }
        statement(*s);
    }
}

void BodyChecker::body(Statement& s)
{
    open_scope();
    statement(s);
    close_scope();
}

void BodyChecker::check(Span, ast::Scope& node)
{
    open_scope();
    statements(node.statements);
    close_scope();
}

void BodyChecker::check(Span, Declaration& node)
{
    const std::string& written = node.type.base.text;
    const std::string_view prefix = PrefixedName(written).prefix;
    if (!prefix.empty() &&
        (find_local(prefix) || std::ranges::find(context.inputs, prefix, &Symbol::name) != context.inputs.end())) {
        fail(node.type.base.span, "unknown-type", quoted(written) + " is a value, expected a type",
             "is a ';' or an operator missing behind it?");
        in_damaged_body = true; // what is read or not is a consequence
    }
    const bool is_told = !type_named(written) && !scope.structure(written) && may_be_unread(written);
    if (is_told) diagnostics.count_consequence();
    Type type = is_told ? Type::error() : value_type(context, node.type, "a variable holds a value", false);
    if (node.type.is_array) {
        node.symbol = &array(node, type);
        return;
    }
    Expression* value = node.initializer.get();
    const uint32_t reports = diagnostics.reports();
    auto braces = value ? std::get_if<BraceList>(&value->node) : nullptr;
    if (braces && !braces->type && type.is_struct()) {
        for (ExpressionPtr& element : braces->elements) expression(*element);
        fail(value->span, "struct", "a struct is made by its constructor, found braces",
             "write " + constructor_of(type));
    } else if (value) {
        expression(*value);
        require(*value, type, " for " + quoted(node.name.text));
    } else if (node.is_const) {
        type =
            fail(node.name.span, "missing-value", "constant " + quoted(node.name.text) + " has no value, expected '='");
    }
    const bool is_sound = diagnostics.reports() == reports;
    const Expression* varies = value && node.is_const ? first_not_constant(*value) : nullptr;
    if (varies && is_global && !value->type.is_error() && !varies->type.is_error())
        diagnostics.error(varies->span, "not-constant",
                          "a global is constant, expected a value known when the texture is compiled",
                          "literals, other constants and built-in functions of them are");
    const bool is_constant = is_sound && node.is_const && !varies;
    Symbol& symbol = declare(node.name, is_constant ? SymbolKind::constant : SymbolKind::local, type);
    node.symbol = &symbol;
    if (value) symbol.is_read |= !is_sound; // that it is not used is then not worth saying
    if (node.is_const) symbol.read_only = "it is constant";
    if (is_constant) {
        symbol.value = context.constants.value(*value, type);
        if (is_integer(type)) {
            const auto number = static_cast<int64_t>(as_number(symbol.value.front(), type));
            symbol.range = ir::IntRange{number, number};
        }
    } else if (value) {
        flow.variables[symbol.slot].assigned = all_parts;
        if (value->type == type) hold(flow.variables[symbol.slot], *value);
    }
}

void BodyChecker::check(Span span, Assignment& node)
{
    expression(*node.value);
    const Target target = target_of(*node.target, "before '='");
    if (!target.symbol) {
        // Whatever was meant has a value now.
        if (auto name = std::get_if<NameExpression>(&node.target->node))
            if (Symbol* local = find_local(name->name); local && local->kind == SymbolKind::local)
                flow.variables[local->slot].assigned = all_parts;
        return;
    }
    const Type type = node.target->type;
    Variable& variable = flow.variables[target.symbol->slot];
    if (!node.op) {
        require(*node.value, type, " for " + quoted(excerpt(*node.target)));
        if (node.value->type == type) hold(variable, *node.value);
        variable.assigned |= target.parts;
        target.symbol->parts_assigned |= target.parts;
        return;
    }
    const bool was_read = target.symbol->is_read; // "x += 1" alone is no use of x
    if (target.parts & ~variable.assigned) expression(*node.target);
    target.symbol->is_read = was_read;
    target.symbol->parts_assigned |= target.parts;
    variable.hold(full_range(type));
    if (node.value->type.is_error()) return;
    adopt_literal(*node.value, operand_type(type));
    const auto types = operator_types(*node.op, type, node.value->type);
    if (!types) {
        report_operator(*node.op, span, type, *node.value);
    } else if (types->result != type) {
        diagnostics.error(node.value->span, "type-mismatch",
                          std::string(describe(operator_of(*node.op).assignment)) + " would make " +
                              quoted(excerpt(*node.target)) + " a " + to_string(types->result) + ", expected " +
                              to_string(type),
                          !types->result.is_scalar() ? "declare it as " + to_string(types->result)
                                                     : "write " + to_string(type) + "(...) round the value");
    }
}

void BodyChecker::check(Span span, ExpressionStatement& node)
{
    const uint32_t reports = diagnostics.reports();
    if (expression(*node.expression).is_error() || in_damaged_body || diagnostics.reports() > reports) return;
    if (written_by_calls && !written_by_calls->empty()) return;
    diagnostics.warning(span, "useless-statement", "this value is not used, and computing it changes nothing",
                        "assign it to a variable or leave it out");
}

void BodyChecker::condition(ExpressionPtr& e, const char* of_what)
{
    if (!e || expression(*e).is_error() || e->type == bool_type) return;
    Diagnostic& reported = diagnostics.error(e->span, "type-mismatch",
                                             std::string("expected bool ") + of_what + ", found " + to_string(e->type));
    if (e->type == float_type || is_integer(e->type))
        reported.hint = "compare: " + operand(*e) + (e->type == float_type ? " != 0.0" : " != 0");
    else if (e->type.is_vector() && e->type.scalar == Scalar::bool_)
        reported.hint = "write any(" + excerpt(*e) + ") or all(" + excerpt(*e) + ")";
}

// What holds on either of two paths; a path that does not go on has no say.
void BodyChecker::merge(Flow& into, const Flow& other) const
{
    if (!other.reachable) return;
    if (!into.reachable) into = other;
    for (size_t i = 0; i < std::min(into.variables.size(), other.variables.size()); ++i) {
        into.variables[i].assigned &= other.variables[i].assigned;
        into.variables[i].range = ir::join(into.variables[i].range, other.variables[i].range);
        into.variables[i].called = ir::join(into.variables[i].called, other.variables[i].called);
    }
}

void BodyChecker::check(Span, If& node)
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
    flow.reachable = after.reachable;
    if (after.reachable) flow = std::move(after);
}

void BodyChecker::check(Span span, Break&)
{
    if (switch_exit) {
        merge(*switch_exit, flow);
        flow.reachable = false;
    } else {
        leave_loop(span, "'break' leaves a loop or a switch");
    }
}

void BodyChecker::check(Span span, Continue&)
{
    leave_loop(span, "'continue' ends one turn of a loop");
}

void BodyChecker::leave_loop(Span span, const char* what)
{
    flow.reachable = false;
    if (loop_depth > 0 || in_damaged_body) return;
    diagnostics.error(span, "misplaced-break", std::string(what) + ", and there is none round it");
    in_damaged_body = true; // what follows is reached, if it is left out
}

void BodyChecker::check(Span span, Return& node)
{
    if (!node.value) {
        if (result_type != void_type && !result_type.is_error()) // of what returns nothing, enough has been said
            diagnostics.error(span, "missing-value", "expected a " + to_string(result_type) + " behind 'return'");
    } else {
        expression(*node.value);
        if (result_type == void_type && !node.value->type.is_error())
            diagnostics.error(node.value->span, "type-mismatch",
                              quoted(owner_name) + " returns nothing, found " + to_string(node.value->type),
                              "its results are its 'out' parameters");
        else
            require(*node.value, result_type, " from " + quoted(owner_name));
    }
    require_outputs(span);
    flow.reachable = false;
}

} // namespace haptel::lang
