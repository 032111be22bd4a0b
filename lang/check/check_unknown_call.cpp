// Calls of what is no function: a variable, a word of another language, a slip.
#include "lang/check/body_checker.h"
#include "lang/syntax/foreign.h"
#include "lang/text/near_name.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

// "clamp($1, 0.0, 1.0)" with the arguments' text in place; nothing if their number differs.
std::optional<std::string> BodyChecker::filled_in(std::string_view pattern,
                                                  const std::vector<ExpressionPtr>& arguments) const
{
    size_t used = 0;
    std::string written;
    const bool is_call = pattern.find(" * ") == pattern.npos && pattern.find(" / ") == pattern.npos &&
                         !pattern.starts_with('!'); // one call as a whole
    for (size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '$') {
            written += pattern[i];
            continue;
        }
        const auto which = static_cast<size_t>(pattern[++i] - '0');
        used = std::max(used, which);
        if (which > arguments.size()) return std::nullopt;
        const Expression& argument = *arguments[which - 1];
        const bool is_part = !is_call && (std::holds_alternative<Chain>(argument.node) ||
                                          std::holds_alternative<Conditional>(argument.node));
        const std::string text(context.sources.text(argument.span));
        written += is_part ? "(" + text + ")" : text;
    }
    if (used != arguments.size()) return std::nullopt;
    return is_call ? written : "(" + written + ")";
}

// A function or type of that name fits the arguments as they are.
bool BodyChecker::takes(std::string_view name, const std::vector<ExpressionPtr>& arguments,
                        const std::vector<Argument>& classes) const
{
    uint32_t components = 0;
    for (size_t i = 0; i < arguments.size(); ++i) {
        if (!classes[i].is_function && arguments[i]->type.is_error()) return false;
        components += arguments[i]->type.components();
    }
    if (const auto type = type_named(name)) return components == type->components();
    const std::vector<Candidate> candidates = scope.functions(name);
    return std::any_of(candidates.begin(), candidates.end(),
                       [&](const Candidate& candidate) { return cost_of(candidate, arguments, classes).has_value(); });
}

void BodyChecker::report_unknown_function(const Expression& e, const Name& callee,
                                          const std::vector<ExpressionPtr>& arguments,
                                          const std::vector<Argument>& classes)
{
    if (const Symbol* variable = find(callee.text)) {
        mark_read(callee.text);
        if (variable->type.is_error()) return; // enough has been said of it
        const std::string found = quoted(callee.text) + " is a " + to_string(variable->type);
        diagnostics.error(callee.span, "not-a-function", found + ", expected a function",
                          "to multiply, write " + callee.text + " * (...)");
        return;
    }
    if (callee.text == "grad") {
        diagnostics.error(callee.span, "grad", "grad takes the name of a function",
                          "put the expression into a function, float f(vec3 q) { return ...; }, and write grad(f)(q)");
        return;
    }
    if (scope.lacks_functions() || may_be_unread(callee.text) || diagnostics.full())
        return diagnostics.count_consequence();
    const auto report = [&]() -> Diagnostic& {
        return diagnostics.error(callee.span, "unknown-function", "unknown function " + quoted(callee.text));
    };
    if (const ForeignWord* foreign = foreign_word(ForeignKind::function, callee.text)) {
        Diagnostic& reported = report();
        reported.hint = foreign->hint;
        const bool is_call = std::holds_alternative<CallExpression>(e.node);
        if (foreign->replacement.find('$') == std::string_view::npos) {
            if (!foreign->replacement.empty()) reported.fix = FixIt{callee.span, std::string(foreign->replacement)};
        } else if (const auto written = filled_in(foreign->replacement, arguments); written && is_call) {
            reported.fix = FixIt{e.span, *written};
        }
        return;
    }
    const std::string_view stem = std::string_view(callee.text).substr(0, callee.text.size() - 1);
    if (callee.text.ends_with('f') && !builtin_overloads(stem).empty()) { // sinf of C
        Diagnostic& reported = report();
        reported.hint = "write " + std::string(stem);
        if (takes(stem, arguments, classes)) reported.fix = FixIt{callee.span, std::string(stem)};
        return;
    }
    if (context.near_searches == 0) {
        report();
        return;
    }
    --context.near_searches;
    std::vector<std::string_view> names{"float", "int",  "uint", "bool", "vec2", "vec3",
                                        "vec4",  "mat2", "mat3", "mat4", "grad"};
    scope.collect_function_names(names);
    if (const auto [nearest, is_only] = near_name(callee.text, names); !nearest.empty()) {
        Diagnostic& reported = report();
        reported.hint = "did you mean " + quoted(nearest) + "?";
        if (is_only && takes(nearest, arguments, classes)) reported.fix = FixIt{callee.span, std::string(nearest)};
    } else if (context.unknown_functions.insert(callee.text).second) {
        report();
    } else {
        diagnostics.count_consequence();
    }
}

} // namespace haptel::lang
