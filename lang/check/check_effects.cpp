// What a call does besides having a value: it writes arguments, leaves some out, and says between what the callee's
// whole numbers lie.
#include "lang/check/body_checker.h"
#include "lang/check/type_hint.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

ExpressionPtr left_out(Span where, const ParameterInfo& parameter)
{
    auto made = std::make_unique<Expression>();
    made->span = where;
    made->type = parameter.type;
    made->node = LeftOut{&parameter};
    return made;
}

// Gives the arguments that it writes a value, once those that it reads are read.
void BodyChecker::write(const Candidate& function, std::vector<ExpressionPtr>& arguments, const Targets& targets,
                        Span call)
{
    for (size_t i = 0; i < arguments.size(); ++i) // what only another function of that name writes is read
        if (targets[i] && (function.parameters[i].passing != Passing::out)) expression(*arguments[i]);
    for (size_t i = 0; i < arguments.size(); ++i) {
        if (!function.parameters[i].is_written() || std::holds_alternative<LeftOut>(arguments[i]->node)) continue;
        Symbol& symbol = *targets[i]->symbol;
        Variable& variable = flow.variables[symbol.slot];
        variable.assigned |= targets[i]->parts;
        variable.hold(full_range(symbol.type));
        symbol.parts_assigned |= targets[i]->parts;
        symbol.is_read = true;
        if (written_by_calls) written_by_calls->push_back(&symbol);
    }
    if (choice_depth == 0 || std::ranges::none_of(function.parameters, &ParameterInfo::is_written)) return;
    diagnostics.error(call, "output-parameter",
                      "a call that writes its arguments cannot stand where it may be left out, or made twice",
                      "not in ?:, behind && or ||, in the head of a loop, an index of what is written or an argument "
                      "of a texture: call it in a statement above");
}

// At a return, or at the end of a function without one.
void BodyChecker::require_outputs(Span where)
{
    for (const Symbol* output : must_be_written) {
        uint64_t& assigned = flow.variables[output->slot].assigned;
        const uint64_t missing = parts_of(output->type) & ~assigned;
        if (!missing || in_damaged_body || output->type.is_error()) continue;
        assigned = all_parts;
        if (!(missing & ~output->parts_assigned)) {
            diagnostics
                .warning(output->span, "perhaps-unassigned",
                         "the output " + quoted(output->name) + " has no value on some path, and is 0 there",
                         "give it one first: " + output->name + " = " + zero_of(output->type) + ";")
                .related.push_back({where, "where the function ends"});
            continue;
        }
        diagnostics
            .error(where, "unassigned", "the output " + quoted(output->name) + " has no value here on every path",
                   "give it one first: " + output->name + " = " + zero_of(output->type) + ";")
            .related.push_back({output->span, quoted(output->name) + " is declared here"});
    }
}

// Between what the callee's whole numbers lie; what it is called with where it is only passed on, nobody knows.
void BodyChecker::note_ranges(const FunctionInfo& callee, const std::vector<ExpressionPtr>& arguments)
{
    // What is not compiled calls nothing, and the library is shared.
    if (is_never_called || callee.is_library) return;
    auto& info = const_cast<FunctionInfo&>(callee); // what is found out of it is owned by the program being checked
    info.is_mentioned = true;
    for (size_t i = 0; i < info.parameters.size(); ++i) {
        ParameterInfo& parameter = info.parameters[i];
        if (!is_integer(parameter.type) || parameter.is_function) continue;
        ir::IntRange here = full_range(parameter.type);
        const bool is_left_out = !arguments.empty() && std::holds_alternative<LeftOut>(arguments[i]->node);
        if (!arguments.empty() && !is_left_out && !is_left_open(*arguments[i]) &&
            converts(*arguments[i], parameter.type)) {
            here = range_over_calls(*arguments[i]);
        } else if (is_left_out && !parameter.value_parts.empty()) {
            const auto number = static_cast<int64_t>(as_number(parameter.value_parts.front(), parameter.type));
            here = {number, number};
        }
        parameter.range = parameter.range ? ir::join(*parameter.range, here) : here;
    }
}

} // namespace haptel::lang
