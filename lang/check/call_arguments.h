// The arguments of a call as its function is looked for: values, functions, and those that are left open.
#pragma once

#include "lang/check/body_checker.h"

#include <algorithm>

namespace haptel::lang {

struct BodyChecker::Argument {
    ast::Expression* tree;
    std::vector<Candidate> functions; // that it may mean; none: it is a value
    bool is_open = false;             // "_"

    // Of a call with open arguments, "f(_, 2.0)"; `functions` are then what is left of these, and take what is open.
    struct Left {
        Candidate of;
        std::vector<ParameterInfo> parameters;
        std::optional<Candidate> rival = {}; // that fits equally well and leaves the same
    };
    std::vector<Left> left = {};
    std::vector<Argument> arguments = {};

    bool is_function() const { return !functions.empty(); }

    // The function that is passed; null if none fits.
    const Candidate* passed_as(const ParameterInfo& parameter) const
    {
        const auto same = [](const ParameterInfo& p, Type type) {
            return !p.is_function && !p.is_written() && p.type == type;
        };
        const auto found = std::ranges::find_if(functions, [&](const Candidate& candidate) {
            return parameter.is_function && candidate.result == parameter.type &&
                   std::ranges::equal(candidate.parameters, parameter.signature, same);
        });
        return found == functions.end() ? nullptr : &*found;
    }
    bool fits(const ParameterInfo& parameter) const
    {
        if (is_open) return !parameter.is_function && !parameter.is_written();
        if (parameter.is_function || is_function()) return passed_as(parameter);
        if (parameter.is_written()) return tree->type == parameter.type; // what it gets is of its own type
        return converts(*tree, parameter.type);
    }
};

struct BodyChecker::Call {
    const ast::Expression& tree;
    const ast::Name& callee;
    std::vector<Argument> arguments;

    bool fits(const Candidate& candidate) const
    {
        const auto fits = [](const Argument& argument, const ParameterInfo& p) { return argument.fits(p); };
        return takes_as_many(candidate) &&
               std::ranges::equal(arguments, candidate.parameters.first(arguments.size()), fits);
    }
    bool takes_as_many(const Candidate& candidate) const
    {
        const size_t given = arguments.size(), all = candidate.parameters.size();
        return given == all || (given < all && candidate.parameters[given].value);
    }
    // Arguments that become what a function takes, which they fit, and those that are left out.
    ptrdiff_t conversions(const Candidate& candidate) const
    {
        ptrdiff_t count = std::ssize(candidate.parameters) - std::ssize(arguments);
        for (size_t i = 0; i < arguments.size(); ++i)
            count += !arguments[i].is_open && !arguments[i].is_function() &&
                     arguments[i].tree->type != candidate.parameters[i].type;
        return count;
    }
};

inline bool is_valid(const Candidate& candidate)
{
    if (auto source = std::get_if<const FunctionInfo*>(&candidate.function)) return (*source)->is_valid;
    const auto is_error = [](const ParameterInfo& parameter) { return parameter.type.is_error(); };
    return !candidate.result.is_error() && std::ranges::none_of(candidate.parameters, is_error);
}

inline const FunctionInfo* source_of(const FunctionReference& function)
{
    auto source = std::get_if<const FunctionInfo*>(&function);
    return source ? *source : nullptr;
}

} // namespace haptel::lang
