// A texture called by another: by the names of its parameters, and of inputs that it is to read otherwise.
#include "lang/check/body_checker.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

// `arguments` stand in the order of the parameters afterwards, with what is left out.
Type BodyChecker::texture_call(Expression& e, CallExpression& call)
{
    FunctionInfo* const callee = scope.texture(call.callee.text);
    const uint32_t reports = diagnostics.reports();
    if (!callee || !callee->is_valid) {
        for (ExpressionPtr& argument : call.arguments) expression(*argument);
        if (callee || may_be_unread(call.callee.text) || diagnostics.reports() > reports) return Type::error();
        for (const Name& name : call.names)
            if (!name.text.empty() && find(name.text))
                return fail(name.span, "assignment-in-expression",
                            "an assignment to " + quoted(name.text) + " is a statement of its own, not part of a call",
                            "write it on a line before");
        return fail(call.callee.span, "named-argument",
                    "only a texture takes arguments by name, and there is no texture " + quoted(call.callee.text),
                    "leave the names out");
    }
    std::vector<ExpressionPtr> ordered(callee->parameters.size());
    Targets targets(ordered.size());
    bool is_sound = true;
    ++choice_depth; // arguments are computed in the order of the parameters
    for (size_t i = 0; i < call.arguments.size(); ++i) is_sound &= named_argument(call, *callee, i, ordered, targets);
    --choice_depth;
    for (size_t i = 0; i < ordered.size(); ++i) {
        if (ordered[i]) continue;
        const ParameterInfo& parameter = callee->parameters[i];
        ordered[i] = left_out(e.span, parameter);
        if (!is_sound || parameter.value || parameter.is_written()) continue;
        diagnostics.error(e.span, "named-argument",
                          "the texture " + quoted(callee->name) + " needs its image " + quoted(parameter.name),
                          "write " + callee->name + "(" + parameter.name + " = ...)");
        is_sound = false;
    }
    call.arguments = std::move(ordered);
    call.names.clear();
    call.target.function = callee;
    call.target.function_arguments.assign(call.arguments.size(), {});
    if (!is_sound || diagnostics.reports() > reports) return Type::error();
    write(Candidate(*callee), call.arguments, targets, e.span);
    mentions.push_back({callee, call.callee.span, 0});
    note_ranges(*callee, call.arguments);
    return float_type;
}

// Puts the argument where it belongs; false once something was reported of it.
bool BodyChecker::named_argument(CallExpression& call, const FunctionInfo& callee, size_t index,
                                 std::vector<ExpressionPtr>& ordered, Targets& targets)
{
    ExpressionPtr& argument = call.arguments[index];
    const Name name = index < call.names.size() ? call.names[index] : Name{};
    const auto parameter = std::ranges::find(callee.parameters, name.text, &ParameterInfo::name);
    const auto refuse = [&](Span where, std::string message, std::string_view hint) {
        expression(*argument);
        diagnostics.error(where, "named-argument", std::move(message), hint);
        return false;
    };
    if (name.text.empty()) {
        const std::string example = callee.parameters.empty() ? "" : callee.parameters.front().name + " = ";
        return refuse(argument->span, "an argument of the texture " + quoted(callee.name) + " has no name",
                      callee.parameters.empty() ? "it takes none"
                                                : "write " + callee.name + "(" + example + excerpt(*argument) + ")");
    }
    if (parameter == callee.parameters.end()) {
        const auto input = std::ranges::find(context.inputs, name.text, &Symbol::name);
        if (input != context.inputs.end()) {
            expression(*argument);
            require(*argument, (*input)->type, " for the input " + quoted(name.text));
            if (std::ranges::find(call.inputs, (*input)->input, [](auto& one) { return one.first; }) !=
                call.inputs.end())
                return refuse(name.span, quoted(name.text) + " is given twice", "leave one of them out");
            call.inputs.emplace_back((*input)->input, std::move(argument));
            return true;
        }
        std::vector<std::string_view> names;
        for (const ParameterInfo& one : callee.parameters) names.push_back(one.name);
        const NearName near = near_name(name.text, names);
        refuse(name.span, "the texture " + quoted(callee.name) + " has no parameter " + quoted(name.text),
               near.name.empty() ? "haptel info lists them" : "did you mean " + quoted(near.name) + "?");
        return false;
    }
    const auto at = static_cast<size_t>(parameter - callee.parameters.begin());
    if (ordered[at]) return refuse(name.span, quoted(name.text) + " is given twice", "leave one of them out");
    if (parameter->is_written()) {
        targets[at] = target_of(*argument, "for an output");
        if (!targets[at]->symbol) return false;
        if (argument->type != parameter->type)
            return fail(argument->span, "type-mismatch",
                        "expected a " + to_string(parameter->type) + " for the output " + quoted(name.text) +
                            ", found " + to_string(argument->type)) == float_type;
    } else {
        const Choices* const around = std::exchange(choices, parameter->choices);
        expression(*argument);
        choices = around;
        require(*argument, parameter->type, " for " + quoted(name.text));
    }
    ordered[at] = std::move(argument);
    return true;
}

} // namespace haptel::lang
