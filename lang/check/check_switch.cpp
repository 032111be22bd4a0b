// Switches: labels that are told apart, and cases that do not run on into each other.
#include "lang/check/body_checker.h"
#include "lang/syntax/operators.h"

namespace haptel::lang {

using namespace ast;

void BodyChecker::check(Span span, Switch& node)
{
    const Type type = expression(*node.selector);
    if (!type.is_error() && !is_integer(type))
        diagnostics.error(node.selector->span, "type-mismatch",
                          "expected int or uint after 'switch', found " + to_string(type),
                          type == float_type  ? "write int(" + excerpt(*node.selector) + "), which drops the fraction"
                          : type == bool_type ? "write if (" + excerpt(*node.selector) + ")"
                                              : "a switch chooses by a whole number");
    labels(node);
    if (node.cases.empty() && !in_damaged_body)
        diagnostics.warning(span, "empty-body", "this switch has no cases", "leave it out");
    Flow exit{{}, false};
    Flow* const around = std::exchange(switch_exit, &exit);
    bool has_default = false;
    for (Switch::Case& one : node.cases) {
        has_default |= one.is_default();
        const Flow before = flow;
        body(*one.body);
        if (flow.reachable && &one != &node.cases.back() && !in_damaged_body)
            diagnostics.error(one.head, "fall-through", "this case runs on into the next one",
                              "end it with break; labels of one case stand together: case 1: case 2:");
        merge(exit, flow);
        flow = before;
    }
    switch_exit = around;
    if (!has_default) merge(exit, flow);
    flow.reachable = exit.reachable;
    if (exit.reachable) flow = std::move(exit);
}

void BodyChecker::labels(Switch& node)
{
    std::map<int64_t, Span> seen;
    std::optional<Span> otherwise;
    for (Switch::Case& one : node.cases)
        for (ExpressionPtr& e : one.labels) {
            if (e) {
                label(*e, node.selector->type, seen);
            } else if (otherwise) {
                diagnostics.error(one.head, "switch", "this switch has two 'default'", "leave one of them out")
                    .related.push_back({*otherwise, "the first is here"});
            } else {
                otherwise = one.head;
            }
        }
}

void BodyChecker::label(Expression& e, Type selector, std::map<int64_t, Span>& seen)
{
    if (expression(e).is_error() || !is_integer(selector)) return;
    adopt_literal(e, selector);
    if (e.type != selector) {
        require(e, selector, " behind 'case'");
        if (converts(e, selector)) // "case 1u:" of no int
            diagnostics.error(e.span, "type-mismatch",
                              "expected " + to_string(selector) + " behind 'case', found " + to_string(e.type));
        return;
    }
    const ir::IntRange number = range(e);
    if (!number.is_constant()) {
        diagnostics.error(e.span, "not-constant",
                          "expected a value known when the texture is compiled behind 'case', found one that varies",
                          "compare it by if (...) { ... } else if (...) { ... }");
        return;
    }
    const auto [first, is_new] = seen.try_emplace(number.minimum, e.span);
    if (!is_new)
        diagnostics
            .error(e.span, "switch", "there are two cases for " + std::to_string(number.minimum),
                   "leave one of them out")
            .related.push_back({first->second, "the first is here"});
}

} // namespace haptel::lang
