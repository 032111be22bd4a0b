// Calls: overloads, functions as arguments, derivatives of functions; and of what is no function: a
// variable, a word of another language, a slip.
#include "lang/check/call_arguments.h"
#include "lang/syntax/grammar.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

// "float f(vec3 q); float f(vec2 q)", a few of them.
std::string listed(const std::vector<Candidate>& candidates)
{
    constexpr size_t shown = 6;
    std::string text = candidates.size() == 1 ? "it is " : "there are ";
    for (size_t i = 0; i < candidates.size() && i < shown; ++i) text += (i > 0 ? "; " : "") + to_string(candidates[i]);
    if (candidates.size() > shown) text += "; and " + std::to_string(candidates.size() - shown) + " more";
    return text;
}

} // namespace

Type BodyChecker::check(Expression& e, CallExpression& call)
{
    if (const auto type = type_named(call.callee.text)) {
        if (!call.names.empty())
            diagnostics.error(call.callee.span, "named-argument",
                              "the parts of a " + to_string(*type) + " have no names", "leave the names out");
        return constructor(e, call, *type);
    }
    if (StructDeclaration* structure = scope.structure(call.callee.text)) {
        const Type type = type_of_struct(context, *structure, call.callee.span);
        if (!call.names.empty())
            return fail(call.callee.span, "named-argument",
                        "the members of " + to_string(type) + " are given in their order, without names",
                        "leave the names out");
        if (!type.is_error()) return struct_constructor(e, call, type);
        for (ExpressionPtr& argument : call.arguments) expression(*argument);
        return type;
    }
    const ForeignWord* foreign = foreign_word(ForeignKind::type, call.callee.text);
    if (foreign && !find(call.callee.text) && scope.functions(call.callee.text).empty()) {
        Diagnostic& reported =
            diagnostics.error(call.callee.span, "foreign-word", quoted(call.callee.text) + " is not a type of Haptel");
        propose(reported, call.callee.span, *foreign);
        if (const auto type = type_named(foreign->replacement)) return constructor(e, call, *type);
        for (ExpressionPtr& argument : call.arguments) expression(*argument);
        return Type::error();
    }
    if (call.callee.text == any_size) { // where it stands for no size
        for (ExpressionPtr& argument : call.arguments) expression(*argument);
        return resolve_type(context, TypeName{.base = call.callee, .is_array = false, .array_size = nullptr});
    }
    if (call.target.function != FunctionReference{} && !call.target.is_constructor) { // checked before
        check_again(call);
        return e.type;
    }
    const auto may_be_meant = [&](const Candidate& candidate) {
        return !call.arguments.empty() || candidate.parameters.empty() || candidate.parameters.front().value;
    };
    const bool is_function =
        find(call.callee.text) || std::ranges::any_of(scope.functions(call.callee.text), may_be_meant);
    if (call.is_of_texture || !call.names.empty() || (!is_function && scope.texture(call.callee.text)))
        return texture_call(e, call);
    Type result;
    resolve(e, call.callee, call.arguments, 0, call.target, result);
    return result;
}

Type BodyChecker::check(Expression& e, GradCall& call)
{
    Type made;
    const auto chosen = resolve(e, call.function, call.arguments, call.order, call.target, made);
    if (!chosen) return Type::error();
    if (std::ranges::any_of(chosen->parameters, &ParameterInfo::is_written))
        return fail(e.span, "not-differentiable", "grad is of functions that only return a value",
                    "the function is " + to_string(*chosen));
    const auto first = std::find_if(chosen->parameters.begin(), chosen->parameters.end(),
                                    [](const ParameterInfo& p) { return !p.is_function && p.type != image_type; });
    const Type argument = first == chosen->parameters.end() ? void_type : first->type;
    if (argument.scalar != Scalar::float_ || argument.is_matrix() || argument.is_array())
        return fail(
            e.span, "not-differentiable",
            "grad is with respect to the first argument that is no function: expected float or a vector, found " +
                (argument == void_type ? std::string("none") : to_string(argument)),
            "the function is " + to_string(*chosen));
    if (chosen->result.scalar != Scalar::float_ || chosen->result.is_array())
        return fail(e.span, "not-differentiable",
                    "expected a function that returns float, a vector or a matrix, found one that returns " +
                        to_string(chosen->result),
                    "the function is " + to_string(*chosen));
    // Column j of a matrix is the derivative by component j; a float changes no shape.
    for (uint32_t order = 0; order < call.order && argument != float_type; ++order)
        made = made == float_type ? argument : made == argument ? mat(made.size) : Type::error();
    if (!made.is_error()) return made;
    const std::string what = call.order == 1 ? "the derivative" : "a derivative of order " + std::to_string(call.order);
    return fail(
        e.span, "not-differentiable",
        what + " of " + to_string(chosen->result) + " with respect to " + to_string(argument) +
            " has no type: it is no number, vector or square matrix",
        "what is possible: a float function of a vector, twice; a vector function of a vector of its size, once; "
        "any function of a float");
}

// The function that the call means. On success arguments have the parameters' types or convert to them, and `target`
// is filled in. Otherwise the reason is reported. `result` is its type, or that on which all that could be meant agree.
std::optional<Candidate> BodyChecker::resolve(const Expression& e, const Name& callee,
                                              std::vector<ExpressionPtr>& arguments, uint32_t order, CallTarget& target,
                                              Type& result)
{
    Call call{e, callee, {}};
    const std::vector<Candidate> candidates = functions_called(callee.text);
    Targets targets(arguments.size());
    bool damaged = read_arguments(call, arguments, candidates, &targets);
    if (const auto open = std::ranges::find(call.arguments, true, &Argument::is_open); open != call.arguments.end()) {
        diagnostics.error(
            open->tree->span, "open-argument",
            "'_' stands for an argument of a function that is passed, and this call is a value",
            "write the argument; a function that is passed stands as it is, fbm(cellular(_, 0.2), q, 4, 2.0, 0.5)");
        damaged = true;
    }
    if (candidates.empty()) {
        report_unknown_function(call);
        return std::nullopt;
    }
    const auto same_result = [&](const Candidate& c) { return c.result == candidates.front().result; };
    if (std::ranges::all_of(candidates, same_result)) result = candidates.front().result;
    if (damaged || !std::ranges::all_of(candidates, is_valid)) return std::nullopt;

    std::vector<Candidate> best;
    for (const Candidate& candidate : candidates) {
        if (!call.fits(candidate)) continue;
        const auto more = best.empty() ? 0 : call.conversions(candidate) - call.conversions(best.front());
        if (more < 0) best.clear();
        if (more <= 0) best.push_back(candidate);
    }
    if (best.empty()) {
        report_no_match(call, candidates);
        for (const auto& target_here : targets) // whatever was meant has a value now
            if (target_here) flow.variables[target_here->symbol->slot].assigned = all_parts;
        return std::nullopt;
    }
    if (best.size() > 1) {
        diagnostics.error(e.span, "ambiguous-call",
                          "this call of " + quoted(callee.text) + " fits several functions equally well",
                          listed(best) + "; convert arguments to say which, for example float(i)");
        return std::nullopt;
    }
    for (size_t i = arguments.size(); i < best.front().parameters.size(); ++i) {
        arguments.push_back(left_out(e.span, best.front().parameters[i]));
        call.arguments.push_back({arguments.back().get(), {}});
        targets.emplace_back();
    }
    write(best.front(), arguments, targets, e.span);
    target.function = best.front().function;
    const FunctionInfo* source = source_of(target.function);
    if (source || order > 0) mentions.push_back({source, callee.span, order});
    for (size_t i = 0; i < arguments.size(); ++i) {
        const ParameterInfo& parameter = best.front().parameters[i];
        const Candidate* passed = call.arguments[i].passed_as(parameter);
        target.function_arguments.push_back(passed ? pass(call.arguments[i], *passed, order, {source})
                                                   : FunctionReference{});
        if (!passed) adopt_literal(*arguments[i], parameter.type);
    }
    if (source) note_ranges(*source, arguments);
    result = best.front().result;
    return best.front();
}

// That the name means where it is called or passed.
std::vector<Candidate> BodyChecker::functions_called(const std::string& name)
{
    Symbol* local = find_local(name);
    if (!local || local->kind != SymbolKind::function) return scope.functions(name);
    local->is_read = true;
    return {Candidate(*local)};
}

// "sin(p.x / 1,5mm)": the number that was meant; empty: none.
static std::string decimal_comma(const SourceSet& sources, std::span<const ExpressionPtr> arguments)
{
    for (size_t i = 0; i + 1 < arguments.size(); ++i) {
        const Span behind = arguments[i + 1]->span;
        if (!std::holds_alternative<NumberLiteral>(arguments[i + 1]->node) ||
            behind.begin != arguments[i]->span.end + 1)
            continue;
        const std::string_view before = sources.text(arguments[i]->span);
        const size_t digits = before.find_last_not_of("0123456789") + 1;
        if (digits < before.size()) return std::string(before.substr(digits)) + "." + std::string(sources.text(behind));
    }
    return {};
}

// As exact as can be: the argument that is wrong if only one function can be meant, else what there is.
void BodyChecker::report_no_match(const Call& call, const std::vector<Candidate>& candidates)
{
    const std::string name = quoted(call.callee.text);
    std::set<size_t> counts;
    std::vector<Candidate> same_count;
    for (const Candidate& candidate : candidates) {
        size_t most = candidate.parameters.size();
        counts.insert(most);
        while (most > 0 && candidate.parameters[most - 1].value) counts.insert(--most);
        if (call.takes_as_many(candidate)) same_count.push_back(candidate);
    }
    if (same_count.empty()) {
        std::string numbers;
        for (size_t count : counts)
            numbers += (numbers.empty() ? "" : count == *counts.rbegin() ? " or " : ", ") + std::to_string(count);
        const auto* written = std::get_if<CallExpression>(&call.tree.node); // "grad(f)(q)" is none
        const std::string meant = written ? decimal_comma(context.sources, written->arguments) : std::string();
        diagnostics.error(call.tree.span, "wrong-argument-count",
                          name + " takes " + numbers + (*counts.rbegin() == 1 ? " argument" : " arguments") +
                              ", found " + std::to_string(call.arguments.size()),
                          meant.empty() ? listed(candidates) : "decimals stand behind a point: write " + meant);
        return;
    }
    for (size_t i = 0; i < call.arguments.size() && same_count.size() == 1; ++i) {
        const Argument& argument = call.arguments[i];
        const ParameterInfo& parameter = same_count.front().parameters[i];
        if (argument.fits(parameter)) continue;
        Diagnostic& reported = diagnostics.error(
            argument.tree->span, "type-mismatch",
            std::string("expected ") + (parameter.is_function ? "a function " : "") + to_string(parameter) +
                " as argument " + std::to_string(i + 1) + ", found " + found_for(argument),
            listed(same_count));
        if (const std::string hint = hint_to_bind(argument, parameter); !hint.empty()) reported.hint = hint;
        if (source_of(same_count.front().function) && parameter.symbol)
            reported.related.push_back({parameter.symbol->span, quoted(parameter.name) + " is declared here"});
        return;
    }
    std::string types;
    for (const Argument& argument : call.arguments)
        types += (types.empty() ? "" : ", ") +
                 (argument.is_open         ? "_"
                  : argument.is_function() ? "function " + std::string(context.sources.text(argument.tree->span))
                                           : to_string(argument.tree->type));
    diagnostics.error(call.tree.span, "no-matching-function", "no " + name + " takes (" + types + ")",
                      listed(same_count));
}

// "clamp($1, 0.0, 1.0)" with the arguments' text in place; empty if their number differs.
std::string BodyChecker::filled_in(std::string_view pattern, const Call& call) const
{
    std::string written(pattern);
    const bool is_call = pattern.find(" * ") == pattern.npos && pattern.find(" / ") == pattern.npos &&
                         !pattern.starts_with('!'); // one call as a whole
    for (size_t i = 0; i < call.arguments.size(); ++i) {
        const Expression& argument = *call.arguments[i].tree;
        const std::string hole = "$" + std::to_string(i + 1);
        std::string text(context.sources.text(argument.span));
        if (!is_call && is_open(argument)) text = "(" + text + ")";
        if (written.find(hole) == written.npos) return {};
        for (size_t at = 0; (at = written.find(hole, at)) != written.npos; at += text.size())
            written.replace(at, hole.size(), text);
    }
    if (written.find('$') != written.npos) return {};
    return is_call ? written : "(" + written + ")";
}

// A function or type of that name fits the arguments as they are.
bool BodyChecker::takes(std::string_view name, const Call& call) const
{
    uint32_t components = 0;
    for (const Argument& argument : call.arguments) {
        if (argument.is_open) continue;
        if (!argument.is_function() && argument.tree->type.is_error()) return false;
        components += argument.tree->type.components();
    }
    if (const auto type = type_named(name)) return components == type->components();
    return std::ranges::any_of(scope.functions(name), [&](const Candidate& candidate) { return call.fits(candidate); });
}

// What stands before the '.' of a name that is called, and is the prefix of no import.
void BodyChecker::report_unknown_prefix(const Call& call, const PrefixedName& parts)
{
    const std::string prefix(parts.prefix), name(parts.name);
    const Span span{call.callee.span.file, call.callee.span.begin,
                    call.callee.span.begin + static_cast<uint32_t>(prefix.size())};
    const Symbol* const value = find(prefix);
    if (!value) return report_unknown_name(span, prefix);
    mark_read(prefix);
    if (value->type.is_error()) return diagnostics.count_consequence();
    if (std::holds_alternative<GradCall>(call.tree.node)) return report_grad(call.callee.span);
    std::string arguments = prefix;
    for (const Argument& argument : call.arguments)
        arguments += ", " + printable(context.sources.text(argument.tree->span));
    diagnostics.error(call.tree.span, "not-callable", "values have no functions of their own",
                      "write " + name + "(" + arguments + ")"); // GLSL's q.length() counts components
}

void BodyChecker::report_grad(Span span)
{
    diagnostics.error(span, "grad", "grad takes the name of a function",
                      "put the expression into a function, float f(vec3 q) { return ...; }, and write grad(f)(q)");
}

void BodyChecker::report_unknown_function(const Call& call)
{
    const std::string& name = call.callee.text;
    const Span span = call.callee.span;
    if (const Symbol* variable = find(name)) {
        mark_read(name);
        if (variable->type.is_error()) return; // enough has been said of it
        diagnostics.error(span, "not-a-function",
                          quoted(name) + " is a " + to_string(variable->type) + ", expected a function",
                          "to multiply, write " + name + " * (...)");
        return;
    }
    if (name == "grad") return report_grad(span);
    const PrefixedName parts(name);
    if (!parts.prefix.empty() && !scope.by_prefix.contains(parts.prefix)) return report_unknown_prefix(call, parts);
    if (scope.by_prefix.contains(name)) {
        diagnostics.error(span, "not-a-function", quoted(name) + " is the prefix of an import, expected a function",
                          "write " + name + ". and the name of a function of its file");
        return;
    }
    if (scope.may_be_function(name) || may_be_unread(name) || context.unknown_functions.contains(name) ||
        diagnostics.full())
        return diagnostics.count_consequence();
    Diagnostic& reported = diagnostics.error(span, "unknown-function", "unknown function " + quoted(name));
    if (const ForeignWord* foreign = foreign_word(ForeignKind::function, name)) {
        propose(reported, span, *foreign);
        if (foreign->replacement.find('$') == std::string_view::npos) return;
        reported.fix.reset();
        const std::string written = filled_in(foreign->replacement, call);
        if (!written.empty() && std::holds_alternative<CallExpression>(call.tree.node))
            reported.fix = FixIt{call.tree.span, written};
        return;
    }
    const std::string_view stem = std::string_view(name).substr(0, name.size() - 1);
    if (name.ends_with('f') && !builtin_overloads(stem).empty()) { // sinf of C
        reported.hint = "write " + std::string(stem);
        if (takes(stem, call)) reported.fix = FixIt{span, std::string(stem)};
        return;
    }
    std::vector<std::string_view> names;
    if (parts.prefix.empty()) {
        names.assign(types_of_numbers.begin(), types_of_numbers.end());
        names.push_back("grad");
        for (const Declarations* layer : scope.layers)
            for (const auto& [known, structure] : layer->structs) names.push_back(known);
        for (const auto& [known, overloads] : builtin_overloads()) names.push_back(known);
    }
    for (const Declarations* layer : scope.layers_of(parts.prefix))
        for (const auto& [known, functions] : layer->functions) names.push_back(known);
    NearName near = near_name(parts.name, names);
    const std::string behind_prefix = std::string(parts.prefix) + "." + std::string(near.name);
    if (near.name.empty()) context.unknown_functions.insert(name);
    if (!near.name.empty() && !parts.prefix.empty()) near.name = behind_prefix;
    propose(reported, span, near, takes(near.name, call));
}

} // namespace haptel::lang
