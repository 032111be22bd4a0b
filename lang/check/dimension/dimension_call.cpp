// Dimensions of calls: by the rules of what is built in, by looking into what is written.
#include "lang/check/dimension/dimension_checker.h"
#include "lang/text/limits.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

const std::vector<ParameterInfo>* parameters_of(const PassedFunction& function)
{
    if (auto source = std::get_if<const FunctionInfo*>(&function.function)) return &(*source)->parameters;
    if (auto overload = std::get_if<const BuiltinOverload*>(&function.function)) return &(*overload)->parameters;
    return nullptr;
}

} // namespace

std::strong_ordering PassedFunction::operator<=>(const PassedFunction& other) const
{
    if (const auto order = function <=> other.function; order != 0) return order;
    if (const auto order = values <=> other.values; order != 0) return order;
    return std::lexicographical_compare_three_way(functions.begin(), functions.end(), other.functions.begin(),
                                                  other.functions.end());
}

size_t PassedFunction::size() const
{
    size_t all = 1 + values.size();
    for (const PassedFunction& inner : functions) all += inner.size();
    return all;
}

PassedFunction DimensionBody::resolved(const FunctionReference& reference)
{
    if (auto parameter = std::get_if<const Symbol*>(&reference))
        return (*parameter)->slot < functions.size() ? functions[(*parameter)->slot] : PassedFunction{};
    auto bound = std::get_if<const CallExpression*>(&reference);
    if (!bound) return {reference};
    PassedFunction made = resolved((*bound)->target.function);
    bind(made, (*bound)->target, (*bound)->arguments);
    return made.size() <= bound_max ? made : PassedFunction{}; // lowering refuses it
}

// The arguments stand for what is not bound yet.
void DimensionBody::bind(PassedFunction& function, const CallTarget& target,
                         const std::vector<ExpressionPtr>& arguments)
{
    const std::vector<ParameterInfo>* const parameters = parameters_of(function);
    const bool has_functions = !function.functions.empty();
    if (parameters) function.values.resize(parameters->size());
    const auto is_bound = [&](size_t i) {
        return (*parameters)[i].is_function ? has_functions : function.values[i].is_given();
    };
    for (size_t at = 0, i = 0; at < arguments.size(); ++at, ++i) {
        while (parameters && is_bound(i)) ++i;
        const Expression& argument = *arguments[at];
        if (!std::holds_alternative<std::monostate>(target.function_arguments[at])) {
            PassedFunction passed = resolved(target.function_arguments[at]);
            if (parameters) function.functions.push_back(std::move(passed));
            continue;
        }
        if (!target.is_open.empty() && target.is_open[at]) continue;
        const bool is_read = !parameters || (*parameters)[i].passing != Passing::out;
        const bool counts = std::holds_alternative<const FunctionInfo*>(function.function) &&
                            (*parameters)[i].type.scalar != Scalar::float_ && !(*parameters)[i].type.structure;
        const Dimension found = is_read ? expression(argument) : Dimension::any();
        if (parameters) function.values[i] = {counts ? Dimension::plain() : found, &argument};
    }
}

Dimension DimensionBody::constructor(const Expression& e, const CallExpression& node)
{
    if (e.type.is_struct()) {
        for (const ExpressionPtr& argument : node.arguments) expression(*argument);
        return Dimension::any();
    }
    if (e.type.scalar == Scalar::float_) return common(node.arguments, described(e.type));
    for (const ExpressionPtr& argument : node.arguments) {
        const Dimension found = expression(*argument);
        if (e.type.scalar != Scalar::bool_ && !join(found, Dimension::plain()))
            report_expected(node.callee.text + "() expects", *argument, Dimension::plain(), found);
    }
    return Dimension::plain();
}

Dimension DimensionBody::call(const Expression& e, const std::string& name, const CallTarget& target,
                              const std::vector<ExpressionPtr>& arguments, uint32_t order)
{
    PassedFunction callee = resolved(target.function);
    const std::vector<ParameterInfo>* const parameters = parameters_of(callee);
    size_t by = 0; // the first number that is not bound: what a derivative is by
    const auto is_by = [&](size_t i) {
        const bool is_given = i < callee.values.size() && callee.values[i].is_given();
        return !is_given && !(*parameters)[i].is_function && (*parameters)[i].type != image_type;
    };
    while (parameters && by < parameters->size() && !is_by(by)) ++by;
    bind(callee, target, arguments);
    if (!parameters) return Dimension::any();
    auto source = std::get_if<const FunctionInfo*>(&callee.function);
    Call call{e.span, name};
    call.passed = callee.functions;
    for (size_t i = 0; i < parameters->size(); ++i) {
        if ((*parameters)[i].is_function) continue;
        call.values.push_back(callee.values[i].written);
        call.dimensions.push_back(callee.values[i].dimension);
    }

    Dimension result = Dimension::any();
    if (auto overload = std::get_if<const BuiltinOverload*>(&callee.function)) {
        const bool is_power = (*overload)->builtin->id == BuiltinId::pow && order == 0;
        if (is_power && !call.dimensions[0].is_any() && !call.dimensions[0].is_plain()) return power(call);
        result = built_in(call, **overload);
    } else if (source) {
        const Span outer = owner.user_call;
        if (!is_library) owner.user_call = e.span;
        DimensionInstance& made = owner.function(**source, call.passed, call.dimensions);
        instance.callees.push_back(&made);
        if (made.is_at_fault && is_library)
            instance.is_at_fault = true;
        else if (made.is_at_fault)
            blame_call(call, **source);
        owner.user_call = outer;
        result = made.result;
        for (size_t i = 0, next = 0; i < arguments.size() && order == 0; ++i)
            if ((*source)->parameters[i].is_written() && next < made.written.size()) {
                const Dimension written = made.written[next++];
                if (!std::holds_alternative<LeftOut>(arguments[i]->node)) give(*arguments[i], written, *arguments[i]);
            }
    }
    for (uint32_t i = 0; i < order; ++i) result = result / callee.values[by].dimension;
    return result;
}

// pow(x, 1.5) of a length is a length to the 1.5; nothing if the exponent is not known.
Dimension DimensionBody::power(const Call& call)
{
    const Expression &base = *call.values[0], &exponent = *call.values[1];
    const Dimension of_base = call.dimensions[0], of_exponent = call.dimensions[1];
    if (!join(of_exponent, Dimension::plain()))
        report_expected("pow() expects", exponent, Dimension::plain(), of_exponent, " as its exponent");
    if (!first_not_constant(exponent)) {
        const auto parts = owner.constant_values.value(exponent, exponent.type);
        const auto fraction = exponent_near(as_number(parts.front(), exponent.type));
        if (fraction && std::ranges::count(parts, parts.front()) == std::ssize(parts)) return of_base.power(*fraction);
    }
    report_expected("pow() expects", base, Dimension::plain(), of_base, " where its exponent is not constant");
    return Dimension::any();
}

Dimension DimensionBody::built_in(const Call& call, const BuiltinOverload& overload)
{
    const BuiltinId id = overload.builtin->id;
    const DimensionResult made = apply_rule(id, call.dimensions);
    if (!made.fits && made.by_letter) {
        const Dimension found = call.dimensions[made.argument];
        const auto wrong = call.values.begin() + made.argument;
        const auto bare = std::find_if(call.values.begin(), wrong, [](auto* value) { return bare_number(*value); });
        const bool mends_earlier = bare != wrong && made.expected.is_plain();
        report((*wrong)->span,
               call.name + "() expects numbers of one dimension, got " + description(made.expected) + " and " +
                   description(found),
               mends_earlier ? proposal(**bare, found, made.expected) : proposal(**wrong, made.expected, found));
    } else if (!made.fits) {
        report_expected(call.name + "() expects", *call.values[made.argument], made.expected,
                        call.dimensions[made.argument]);
    }
    if (id == BuiltinId::determinant) return call.dimensions[0].power({overload.parameters.front().type.size, 1});
    return made.result;
}

// Library code does not go with these arguments. The argument at fault is the one without whose dimension it does, and
// what it should have is what makes it go.
void DimensionBody::blame_call(const Call& call, const FunctionInfo& callee)
{
    const auto goes_with = [&](const Dimensions& tried) {
        return !owner.function(callee, call.passed, tried).is_at_fault;
    };
    Dimensions candidates{Dimension::plain(), Dimension::length()};
    candidates.insert(candidates.end(), call.dimensions.begin(), call.dimensions.end());
    for (size_t i = 0; i < call.dimensions.size(); ++i) {
        const Dimension found = call.dimensions[i];
        Dimensions tried = call.dimensions;
        tried[i] = Dimension::any();
        if (!goes_with(tried)) continue;
        for (const Dimension expected : candidates) {
            tried[i] = expected;
            if (expected.is_any() || expected == found || !goes_with(tried)) continue;
            const std::string which = expected.is_plain() ? "" : " as argument " + std::to_string(i + 1);
            return report_expected(call.name + "() expects", *call.values[i], expected, found, which);
        }
    }
    Dimensions plain = call.dimensions;
    for (Dimension& dimension : plain)
        if (!dimension.is_any()) dimension = Dimension::plain();
    const bool wants_plain = plain != call.dimensions && goes_with(plain);
    report(call.span,
           call.name + (wants_plain ? "() expects plain numbers, got " : "() does not go with ") +
               description(call.dimensions),
           {"divide lengths by a wavelength"});
}

} // namespace haptel::lang
