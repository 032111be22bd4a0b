// Calls: constructors, overloads, functions as arguments, derivatives of functions.
#include "lang/check/body_checker.h"
#include "lang/syntax/foreign.h"
#include "lang/syntax/grammar.h"
#include "lang/syntax/operators.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

std::string count_of(size_t count, const char* thing)
{
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

// "float f(vec3 q); float f(vec2 q)", a few of them.
std::string listed(const std::vector<Candidate>& candidates)
{
    constexpr size_t shown = 6;
    std::string text = candidates.size() == 1 ? "it is " : "there are ";
    for (size_t i = 0; i < candidates.size() && i < shown; ++i) text += (i > 0 ? "; " : "") + to_string(candidates[i]);
    if (candidates.size() > shown) text += "; and " + std::to_string(candidates.size() - shown) + " more";
    return text;
}

std::string described(const ParameterInfo& parameter)
{
    std::string text = to_string(parameter.type);
    if (!parameter.is_function) return text;
    text = "a function " + text + "(";
    for (size_t i = 0; i < parameter.signature.size(); ++i)
        text += (i > 0 ? ", " : "") + to_string(parameter.signature[i]);
    return text + ")";
}

bool is_valid(const Candidate& candidate)
{
    if (auto source = std::get_if<const FunctionInfo*>(&candidate.function)) return (*source)->is_valid;
    return !candidate.result.is_error() &&
           std::ranges::none_of(candidate.parameters,
                                [](const ParameterInfo& parameter) { return parameter.type.is_error(); });
}

const FunctionInfo* source_of(const FunctionReference& function)
{
    auto source = std::get_if<const FunctionInfo*>(&function);
    return source ? *source : nullptr;
}

// Column j of a matrix is the derivative by component j; an error where no type holds the derivatives.
Type derivative_type(Type of, Type argument)
{
    if (argument == float_type) return of; // shape of what is differentiated
    if (of == float_type) return argument;
    return of == argument ? mat(of.size) : Type::error();
}

bool is_literal_for(const Expression& argument, Type wanted)
{
    return argument.type == int_type && wanted == uint_type && std::holds_alternative<NumberLiteral>(argument.node);
}

} // namespace

Type BodyChecker::check(Expression& e, CallExpression& call)
{
    if (const auto type = type_named(call.callee.text)) return constructor(e, call, *type);
    const ForeignWord* foreign = foreign_word(ForeignKind::type, call.callee.text);
    if (foreign && !find(call.callee.text) && !scope.is_function(call.callee.text)) {
        Diagnostic& reported = diagnostics.error(call.callee.span, "foreign-word",
                                                 quoted(call.callee.text) + " is not a type of Haptel", foreign->hint);
        if (foreign->is_exact && !foreign->replacement.empty())
            reported.fix = FixIt{call.callee.span, std::string(foreign->replacement)};
        if (const auto type = type_named(foreign->replacement)) return constructor(e, call, *type);
        for (ExpressionPtr& argument : call.arguments) expression(*argument);
        return Type::error();
    }
    if (call.callee.text == any_size) { // where it stands for no size
        for (ExpressionPtr& argument : call.arguments) expression(*argument);
        return resolve_type(context, TypeName{.base = call.callee, .is_array = false, .array_size = nullptr});
    }
    Type if_unsure;
    const auto chosen = resolve(e, call.callee, call.arguments, 0, call.target, if_unsure);
    return chosen ? chosen->result : if_unsure;
}

// Scalars convert from any scalar; vectors and matrices join the components of their arguments. One scalar fills a
// vector or the diagonal of a matrix, a longer vector is cut, and a matrix of another size is cut or filled up from the
// unit matrix.
Type BodyChecker::constructor(Expression& e, CallExpression& call, Type type)
{
    bool damaged = false;
    uint32_t components = 0;
    for (size_t i = 0; i < call.arguments.size(); ++i) {
        Expression& argument = *call.arguments[i];
        const Type found = expression(argument);
        damaged |= found.is_error();
        if (!damaged && components >= type.components()) {
            const std::string full =
                type.is_scalar() ? "is made of one value"
                                 : "has all its " + count_of(type.components(), "component") + " before this argument";
            diagnostics.error(argument.span, "wrong-argument-count", to_string(type) + " " + full,
                              "leave this argument out");
            damaged = true;
        }
        if (!damaged && found == image_type) {
            diagnostics.error(argument.span, "image",
                              "expected numbers and vectors for " + to_string(type) + ", found image",
                              "read it: sample(" + excerpt(argument) + ", uv)");
            damaged = true;
        }
        if (!damaged && (found.is_array() || (type.is_matrix() && found.is_matrix() && call.arguments.size() > 1))) {
            diagnostics.error(argument.span, "type-mismatch",
                              "expected numbers and vectors for " + to_string(type) + ", found " + to_string(found),
                              found.is_array() ? "pick elements: " + operand(argument) + "[i]"
                                               : "pick columns: " + operand(argument) + "[0]");
            damaged = true;
        }
        components += found.components();
    }
    call.target.is_constructor = true;
    call.target.function_arguments.assign(call.arguments.size(), {});
    if (damaged) return type;
    if (type == void_type) return fail(e.span, "type-mismatch", "void has no values");
    if (type == image_type)
        return fail(e.span, "image", "an image is not made of values",
                    "it comes with the texture: texture t(image picture) { return 1mm * sample(picture, uv); }");
    const bool fills =
        call.arguments.size() == 1 && (components == 1 || (type.is_matrix() && call.arguments[0]->type.is_matrix()));
    if (components == 0 || (components < type.components() && !fills)) {
        Diagnostic& reported =
            diagnostics.error(e.span, "wrong-argument-count",
                              to_string(type) + " needs " + count_of(type.components(), "component") + ", found " +
                                  std::to_string(components));
        if (type.is_vector()) reported.hint = "one number fills all: " + to_string(type) + "(0.0)";
        if (type.is_matrix()) reported.hint = "one number fills the diagonal: " + to_string(type) + "(1.0)";
    }
    return type;
}

Type BodyChecker::check(Expression& e, GradCall& call)
{
    Type if_unsure;
    const auto chosen = resolve(e, call.function, call.arguments, call.order, call.target, if_unsure);
    if (!chosen) return Type::error();
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
    Type made = chosen->result;
    for (uint32_t order = 0; order < call.order && !made.is_error(); ++order) made = derivative_type(made, argument);
    if (!made.is_error()) return made;
    std::string what = "the derivative";
    if (call.order > 1)
        what = call.order == 2 ? "the second derivative" : "a derivative of order " + std::to_string(call.order);
    return fail(
        e.span, "not-differentiable",
        what + " of " + to_string(chosen->result) + " with respect to " + to_string(argument) +
            " has no type: it is no number, vector or square matrix",
        "what is possible: a float function of a vector, twice; a vector function of a vector of its size, once; "
        "any function of a float");
}

// The function that the call means. On success arguments have the parameters' types or convert to them, and `target`
// is filled in. Otherwise the reason is reported; `if_unsure` is the result if all that could be meant agree on it.
std::optional<Candidate> BodyChecker::resolve(const Expression& e, const Name& callee,
                                              std::vector<ExpressionPtr>& arguments, uint32_t order, CallTarget& target,
                                              Type& if_unsure)
{
    std::vector<Argument> classes;
    bool damaged = false;
    for (ExpressionPtr& argument : arguments) {
        classes.push_back(classify(*argument));
        damaged |= classes.back().is_function ? !std::ranges::all_of(classes.back().functions, is_valid)
                                              : argument->type.is_error();
    }
    std::vector<Candidate> candidates;
    if (Symbol* local = find_local(callee.text); local && local->kind == SymbolKind::function) {
        local->is_read = true;
        candidates.push_back(candidate_of(*local));
    } else {
        candidates = scope.functions(callee.text);
    }
    if (candidates.empty()) {
        report_unknown_function(e, callee, arguments, classes);
        return std::nullopt;
    }
    const auto same_result = [&](const Candidate& c) { return c.result == candidates.front().result; };
    if (std::all_of(candidates.begin(), candidates.end(), same_result)) if_unsure = candidates.front().result;
    if (damaged || !std::all_of(candidates.begin(), candidates.end(), is_valid)) return std::nullopt;

    const Candidate* best = nullptr;
    int best_cost = 0;
    std::vector<Candidate> ties;
    for (const Candidate& candidate : candidates) {
        const auto cost = cost_of(candidate, arguments, classes);
        if (!cost || (best && *cost > best_cost)) continue;
        if (!best || *cost < best_cost) ties.clear();
        ties.push_back(candidate);
        best = &candidate;
        best_cost = *cost;
    }
    if (!best) {
        report_no_match(e, callee, arguments, classes, candidates);
        return std::nullopt;
    }
    if (ties.size() > 1) {
        diagnostics.error(e.span, "ambiguous-call",
                          "this call of " + quoted(callee.text) + " fits several functions equally well",
                          listed(ties) + "; convert arguments to say which, for example float(i)");
        return std::nullopt;
    }
    target.function = best->function;
    const FunctionInfo* source = source_of(best->function);
    if (source || order > 0) mentions.push_back({source, callee.span, order, nullptr});
    for (size_t i = 0; i < arguments.size(); ++i) {
        const Candidate* passed = passed_function(classes[i], best->parameters[i]);
        target.function_arguments.push_back(passed ? passed->function : FunctionReference{});
        if (passed) mentions.push_back({source_of(passed->function), arguments[i]->span, order, source});
        if (!passed && is_literal_for(*arguments[i], best->parameters[i].type)) arguments[i]->type = uint_type;
    }
    return *best;
}

// A name that is no variable but a function is passed as one; anything else is a value.
BodyChecker::Argument BodyChecker::classify(Expression& argument)
{
    auto name = std::get_if<NameExpression>(&argument.node);
    Symbol* local = name ? find_local(name->name) : nullptr;
    if (local && local->kind == SymbolKind::function) {
        local->is_read = true;
        return {true, {candidate_of(*local)}};
    }
    if (name && !find(name->name) && scope.is_function(name->name)) return {true, scope.functions(name->name)};
    expression(argument);
    return {};
}

const Candidate* BodyChecker::passed_function(const Argument& argument, const ParameterInfo& parameter) const
{
    if (!argument.is_function || !parameter.is_function) return nullptr;
    for (const Candidate& candidate : argument.functions) {
        const auto same = [](const ParameterInfo& p, Type type) { return !p.is_function && p.type == type; };
        if (candidate.result == parameter.type &&
            std::equal(candidate.parameters.begin(), candidate.parameters.end(), parameter.signature.begin(),
                       parameter.signature.end(), same))
            return &candidate;
    }
    return nullptr;
}

// Number of conversions; nothing if the arguments do not fit.
std::optional<int> BodyChecker::cost_of(const Candidate& candidate, const std::vector<ExpressionPtr>& arguments,
                                        const std::vector<Argument>& classes) const
{
    if (candidate.parameters.size() != arguments.size()) return std::nullopt;
    int cost = 0;
    for (size_t i = 0; i < arguments.size(); ++i) {
        const ParameterInfo& parameter = candidate.parameters[i];
        if (parameter.is_function || classes[i].is_function) {
            if (!passed_function(classes[i], parameter)) return std::nullopt;
            continue;
        }
        if (!converts_implicitly(arguments[i]->type, parameter.type) && !is_literal_for(*arguments[i], parameter.type))
            return std::nullopt;
        cost += arguments[i]->type != parameter.type;
    }
    return cost;
}

// As exact as can be: the argument that is wrong if only one function can be meant, else what there is.
void BodyChecker::report_no_match(const Expression& e, const Name& callee, const std::vector<ExpressionPtr>& arguments,
                                  const std::vector<Argument>& classes, const std::vector<Candidate>& candidates)
{
    std::vector<Candidate> same_count;
    for (const Candidate& candidate : candidates)
        if (candidate.parameters.size() == arguments.size()) same_count.push_back(candidate);
    if (same_count.empty()) {
        std::string message = quoted(callee.text) + " takes ";
        std::vector<size_t> counts;
        for (const Candidate& candidate : candidates) counts.push_back(candidate.parameters.size());
        std::sort(counts.begin(), counts.end());
        counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
        for (size_t i = 0; i + 1 < counts.size(); ++i)
            message += std::to_string(counts[i]) + (i + 2 < counts.size() ? ", " : " or ");
        message += count_of(counts.back(), "argument") + ", found " + std::to_string(arguments.size());
        diagnostics.error(e.span, "wrong-argument-count", std::move(message), listed(candidates));
        return;
    }
    if (same_count.size() == 1) {
        for (size_t i = 0; i < arguments.size(); ++i) {
            const ParameterInfo& parameter = same_count.front().parameters[i];
            const bool fits = parameter.is_function
                                  ? passed_function(classes[i], parameter) != nullptr
                                  : !classes[i].is_function && converts_implicitly(arguments[i]->type, parameter.type);
            if (!fits) return report_argument(same_count.front(), i, *arguments[i], classes[i]);
        }
    }
    std::string found;
    for (size_t i = 0; i < arguments.size(); ++i)
        found += (i > 0 ? ", " : "") + (classes[i].is_function
                                            ? "function " + std::string(context.sources.text(arguments[i]->span))
                                            : to_string(arguments[i]->type));
    diagnostics.error(e.span, "no-matching-function", "no " + quoted(callee.text) + " takes (" + found + ")",
                      listed(same_count));
}

void BodyChecker::report_argument(const Candidate& candidate, size_t index, const Expression& argument,
                                  const Argument& argument_class)
{
    const ParameterInfo& parameter = candidate.parameters[index];
    std::string found = to_string(argument.type);
    if (argument_class.is_function)
        found = argument_class.functions.size() == 1 ? "the function " + to_string(argument_class.functions.front())
                                                     : "functions that take other arguments";
    Diagnostic& reported = diagnostics.error(argument.span, "type-mismatch",
                                             "expected " + described(parameter) + " as argument " +
                                                 std::to_string(index + 1) + ", found " + found,
                                             listed({candidate}));
    auto source = std::get_if<const FunctionInfo*>(&candidate.function);
    if (source && parameter.symbol)
        reported.related.push_back({parameter.symbol->span, quoted(parameter.name) + " is declared here"});
}

} // namespace haptel::lang
