// Functions that are passed: by name, or by a call that leaves arguments open, "fbm(cellular(_, 0.2), q, 4, 2.0, 0.5)".
#include "lang/check/call_arguments.h"

namespace haptel::lang {

using namespace ast;

bool BodyChecker::is_left_open(const Expression& e) const
{
    auto name = std::get_if<NameExpression>(&e.node);
    return name && name->name == "_" && !find(name->name);
}

bool BodyChecker::is_binding(const Expression& e) const
{
    auto call = std::get_if<CallExpression>(&e.node);
    return call && std::ranges::any_of(call->arguments, [&](const ExpressionPtr& one) { return is_left_open(*one); });
}

// One after the other, as they are computed. What one of the candidates writes goes into `targets`; null: none of those
// is meant. True once something was reported.
bool BodyChecker::read_arguments(Call& call, std::vector<ExpressionPtr>& arguments,
                                 const std::vector<Candidate>& candidates, Targets* targets)
{
    bool damaged = false;
    for (size_t i = 0; i < arguments.size(); ++i) {
        ExpressionPtr& tree = arguments[i];
        const auto writes_here = [&](const Candidate& c) {
            return i < c.parameters.size() && c.parameters[i].is_written();
        };
        auto name = std::get_if<NameExpression>(&tree->node);
        const Symbol* symbol = name ? find(name->name) : nullptr;
        const bool is_value = !name || (symbol && symbol->kind != SymbolKind::function);
        if (targets && std::ranges::any_of(candidates, writes_here)) {
            (*targets)[i] = target_of(*tree, "for an output");
            damaged |= !(*targets)[i]->symbol;
            call.arguments.push_back({tree.get(), {}});
        } else if (is_left_open(*tree)) {
            call.arguments.push_back({tree.get(), {}, true});
        } else if (is_binding(*tree)) {
            std::optional<Argument> bound = binding(*tree);
            damaged |= !bound;
            call.arguments.push_back(bound ? std::move(*bound) : Argument{tree.get(), {}});
        } else {
            call.arguments.push_back({tree.get(), is_value ? std::vector<Candidate>{} : functions_called(name->name)});
            const std::vector<Candidate>& functions = call.arguments.back().functions;
            damaged |= functions.empty() ? expression(*tree).is_error() : !std::ranges::all_of(functions, is_valid);
        }
    }
    return damaged;
}

// What a call with open arguments may leave; nothing, and reported, if that is no function.
std::optional<BodyChecker::Argument> BodyChecker::binding(Expression& e)
{
    CallExpression& node = std::get<CallExpression>(e.node);
    const bool is_texture = !node.names.empty() || (scope.functions(node.callee.text).empty() &&
                                                    !find(node.callee.text) && scope.texture(node.callee.text));
    if (is_texture || type_named(node.callee.text)) {
        diagnostics.error(e.span, "open-argument",
                          std::string("expected a function before '(', found ") +
                              (is_texture ? "a texture: its arguments are not left open"
                                          : "a type: parts of a value are not left open"),
                          "put it into a function: float f(vec3 q) { return ...; }");
        return std::nullopt;
    }
    Argument made{&e, {}};
    Call call{e, node.callee, {}};
    std::vector<Candidate> candidates = functions_called(node.callee.text);
    const bool damaged = read_arguments(call, node.arguments, candidates, nullptr);
    if (candidates.empty()) report_unknown_function(call);
    if (damaged || candidates.empty() || !std::ranges::all_of(candidates, is_valid)) return std::nullopt;
    for (const Candidate& candidate : candidates) {
        if (!call.fits(candidate) || std::ranges::any_of(candidate.parameters, &ParameterInfo::is_written)) continue;
        Argument::Left left{candidate, {}};
        for (size_t i = 0; i < call.arguments.size(); ++i)
            if (call.arguments[i].is_open) left.parameters.push_back(candidate.parameters[i]);
        const auto twin = std::ranges::find_if(made.left, [&](const Argument::Left& known) {
            return known.of.result == candidate.result && known.parameters == left.parameters;
        });
        if (twin == made.left.end()) {
            made.left.push_back(std::move(left));
            continue;
        }
        const ptrdiff_t more = call.conversions(candidate) - call.conversions(twin->of);
        if (more == 0) twin->rival = candidate;
        if (more < 0) *twin = std::move(left);
    }
    const auto unclear =
        std::ranges::find_if(made.left, [](const Argument::Left& one) { return one.rival.has_value(); });
    if (unclear != made.left.end()) {
        diagnostics.error(e.span, "ambiguous-call",
                          "this call of " + quoted(node.callee.text) + " fits several functions equally well",
                          "it is " + to_string(unclear->of) + " or " + to_string(*unclear->rival) +
                              "; convert arguments to say which, for example float(i)");
        return std::nullopt;
    }
    if (made.left.empty()) {
        std::erase_if(candidates, [](const Candidate& candidate) {
            return std::ranges::any_of(candidate.parameters, &ParameterInfo::is_written);
        });
        if (candidates.empty())
            diagnostics.error(e.span, "open-argument",
                              quoted(node.callee.text) +
                                  " writes its arguments, expected a function that returns a value");
        else
            report_no_match(call, candidates);
        return std::nullopt;
    }
    for (const Argument::Left& left : made.left) {
        made.functions.push_back(left.of);
        made.functions.back().parameters = left.parameters;
    }
    made.arguments = std::move(call.arguments);
    return made;
}

// Settles what the argument means: one of its functions, which is passed to those in `through`, the innermost first.
FunctionReference BodyChecker::pass(Argument& argument, const Candidate& passed, uint32_t order,
                                    std::vector<const FunctionInfo*> through)
{
    const FunctionInfo* const source = source_of(passed.function);
    std::erase(through, nullptr);
    mentions.push_back({source, argument.tree->span, order, through});
    if (argument.left.empty()) {
        if (source) note_ranges(*source, {});
        return passed.function;
    }
    CallExpression& node = std::get<CallExpression>(argument.tree->node);
    const Candidate& of = argument.left[static_cast<size_t>(&passed - argument.functions.data())].of;
    for (size_t i = node.arguments.size(); i < of.parameters.size(); ++i) {
        node.arguments.push_back(left_out(argument.tree->span, of.parameters[i]));
        argument.arguments.push_back({node.arguments.back().get(), {}});
    }
    through.insert(through.begin(), source);
    node.target.function = of.function;
    for (size_t i = 0; i < node.arguments.size(); ++i) {
        const ParameterInfo& parameter = of.parameters[i];
        Argument& inner = argument.arguments[i];
        const Candidate* const function = inner.is_open ? nullptr : inner.passed_as(parameter);
        node.target.is_open.push_back(inner.is_open);
        node.target.function_arguments.push_back(function ? pass(inner, *function, order, through)
                                                          : FunctionReference{});
        if (!inner.is_open && !function) adopt_literal(*inner.tree, parameter.type);
    }
    if (source) note_ranges(*source, node.arguments);
    argument.tree->type = of.result;
    return &node;
}

// Values that a call is made with, whose function is known, are checked where the flow has come to be another.
void BodyChecker::check_again(CallExpression& call)
{
    for (size_t i = 0; i < call.arguments.size(); ++i) {
        if (std::holds_alternative<const CallExpression*>(call.target.function_arguments[i]))
            check_again(std::get<CallExpression>(call.arguments[i]->node));
        else if (call.target.function_arguments[i] == FunctionReference{} &&
                 (call.target.is_open.empty() || !call.target.is_open[i]))
            expression(*call.arguments[i]);
    }
}

// What stands where another argument is expected, for messages.
std::string BodyChecker::found_for(const Argument& argument) const
{
    if (argument.is_open) return "'_'";
    if (!argument.is_function()) return to_string(argument.tree->type);
    std::string functions;
    for (const Candidate& candidate : argument.functions)
        functions += (functions.empty() ? "" : "; ") + to_string(candidate);
    if (!argument.left.empty()) return excerpt(*argument.tree) + ", which leaves " + functions;
    return argument.functions.size() == 1 ? "the function " + functions : "functions that take other arguments";
}

// "bind the others: cellular(_, smoothing)", where a function takes what is wanted and more; else empty.
std::string BodyChecker::hint_to_bind(const Argument& argument, const ParameterInfo& wanted) const
{
    if (!argument.left.empty() || !wanted.is_function) return {};
    for (const Candidate& candidate : argument.functions) {
        if (candidate.result != wanted.type || candidate.parameters.size() <= wanted.signature.size()) continue;
        const auto same = [](const ParameterInfo& p, Type type) { return !p.is_function && p.type == type; };
        if (!std::ranges::equal(candidate.parameters.first(wanted.signature.size()), wanted.signature, same)) continue;
        std::string written = name_of(candidate.function) + "(";
        for (size_t i = 0; i < candidate.parameters.size(); ++i) {
            const std::string& name = candidate.parameters[i].name;
            written += (i > 0 ? ", " : "") + (i < wanted.signature.size() ? "_" : name.empty() ? "1.0" : name);
        }
        return "bind what it takes besides: " + written + ")";
    }
    return {};
}

} // namespace haptel::lang
