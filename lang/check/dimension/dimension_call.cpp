// Dimensions of calls: by the rules of what is built in, by looking into what is written.
#include "lang/check/dimension/dimension_checker.h"
#include "lang/check/dimension/dimension_rules.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

Dimension derivative(Dimension of, Dimension by, uint32_t order)
{
    for (uint32_t i = 0; i < order; ++i) of = of / by;
    return of;
}

// The number that a constant exponent is; nothing if it varies, or is a vector of different numbers.
std::optional<double> constant_exponent(ConstantEvaluator& values, const Expression& e)
{
    if (e.type.is_error() || first_not_constant(e)) return std::nullopt;
    const auto parts = values.value(e, e.type);
    const double value = as_number(parts.front(), e.type);
    for (const ConstantPart& part : parts)
        if (as_number(part, e.type) != value) return std::nullopt;
    return value;
}

} // namespace

std::string description(std::span<const Dimension> dimensions)
{
    std::string text;
    for (size_t i = 0; i < dimensions.size(); ++i)
        text += (i == 0 ? "" : i + 1 < dimensions.size() ? ", " : " and ") + description(dimensions[i]);
    return text;
}

FunctionReference DimensionBody::resolved(const FunctionReference& reference) const
{
    auto parameter = std::get_if<const Symbol*>(&reference);
    if (!parameter) return reference;
    return (*parameter)->slot < functions.size() ? functions[(*parameter)->slot] : FunctionReference{};
}

Dimension DimensionBody::find(const Expression& e, const CallExpression& node)
{
    if (node.target.is_constructor) return constructor(e, node);
    return call(e, node.callee.text, node.target, node.arguments, 0);
}

Dimension DimensionBody::find(const Expression& e, const GradCall& node)
{
    return call(e, node.function.text, node.target, node.arguments, node.order);
}

Dimension DimensionBody::constructor(const Expression& e, const CallExpression& node)
{
    if (e.type.scalar == Scalar::float_)
        return common(node.arguments, e.type.is_matrix() ? "a matrix" : e.type.is_vector() ? "a vector" : "a number");
    for (const ExpressionPtr& argument : node.arguments) {
        const Dimension found = expression(*argument);
        if (e.type.scalar != Scalar::bool_ && !join(found, Dimension::plain()))
            report_expected(node.callee.text + "() expects", *argument, Dimension::plain(), found);
    }
    return Dimension::plain();
}

// pow(x, 1.5) of a length is a length to the 1.5; nothing if the exponent is not known or x has no dimension.
Dimension DimensionBody::power(const CallExpression& node, Dimension base)
{
    const auto exponent = constant_exponent(owner.constant_values, *node.arguments[1]);
    const auto fraction = exponent ? exponent_near(*exponent) : std::nullopt;
    if (fraction) return base.power(*fraction);
    if (auto finding =
            report(node.arguments[0]->span, "pow() expects a plain number where its exponent is not constant, got " +
                                                description(base) + ": " + advice_to_plain(base)))
        propose(*finding, *node.arguments[0], Dimension::plain(), base);
    return Dimension::any();
}

Dimension DimensionBody::call(const Expression& e, const std::string& name, const CallTarget& target,
                              const std::vector<ExpressionPtr>& arguments, uint32_t order)
{
    const FunctionReference callee = resolved(target.function);
    FunctionReferences passed;
    Dimensions dimensions;
    std::vector<const Expression*> values;
    for (size_t i = 0; i < arguments.size(); ++i) {
        const bool is_function = !std::holds_alternative<std::monostate>(target.function_arguments[i]);
        if (is_function) {
            passed.push_back(resolved(target.function_arguments[i]));
            continue;
        }
        values.push_back(arguments[i].get());
        dimensions.push_back(expression(*arguments[i]));
    }
    const Dimension by = dimensions.empty() ? Dimension::any() : dimensions.front();

    if (auto overload = std::get_if<const BuiltinOverload*>(&callee)) {
        const BuiltinId id = (*overload)->builtin->id;
        auto written = std::get_if<CallExpression>(&e.node);
        if (id == BuiltinId::pow && written && !by.is_any() && !by.is_plain()) {
            if (!join(dimensions[1], Dimension::plain()))
                report_expected("pow() expects", *values[1], Dimension::plain(), dimensions[1], " as its exponent");
            return power(*written, by);
        }
        DimensionResult made = apply_rule(id, dimensions);
        if (id == BuiltinId::determinant) made.result = by.power({(*overload)->parameters.front().type.size, 1});
        if (!made.fits && made.by_letter) {
            const Dimension found = dimensions[made.argument];
            auto finding =
                report(values[made.argument]->span, name + "() expects numbers of one dimension, got " +
                                                        description(made.expected) + " and " + description(found));
            const auto bare = std::find_if(values.begin(), values.begin() + made.argument,
                                           [](const Expression* value) { return bare_number(*value) != nullptr; });
            const bool mends_earlier = bare != values.begin() + made.argument && made.expected.is_plain();
            if (finding && mends_earlier)
                propose(*finding, **bare, found, made.expected);
            else if (finding)
                propose(*finding, *values[made.argument], made.expected, found);
        } else if (!made.fits) {
            report_expected(name + "() expects", *values[made.argument], made.expected, dimensions[made.argument]);
        }
        return derivative(made.result, by, order);
    }

    auto source = std::get_if<const FunctionInfo*>(&callee);
    if (!source) return Dimension::any();
    size_t value = 0;
    for (const ParameterInfo& parameter : (*source)->parameters) {
        if (parameter.is_function) continue;
        if (parameter.type.scalar != Scalar::float_) dimensions[value] = Dimension::plain();
        ++value;
    }
    const Span outer = owner.user_call;
    if (!is_library) owner.user_call = e.span;
    const DimensionInstance& made = owner.function(**source, passed, dimensions);
    instance.callees.push_back(&made);
    if (made.is_at_fault) {
        if (is_library)
            instance.is_at_fault = true;
        else
            blame_call(e, name, **source, passed, dimensions, values);
    }
    owner.user_call = outer;
    return derivative(made.result, by, order);
}

// Library code does not go with these arguments. The argument at fault is the one without whose dimension it does, and
// what it should have is what makes it go.
void DimensionBody::blame_call(const Expression& e, const std::string& name, const FunctionInfo& callee,
                               const FunctionReferences& passed, const Dimensions& dimensions,
                               const std::vector<const Expression*>& values)
{
    const auto goes_with = [&](const Dimensions& tried) { return !owner.function(callee, passed, tried).is_at_fault; };
    Dimensions candidates{Dimension::plain(), Dimension::length()};
    candidates.insert(candidates.end(), dimensions.begin(), dimensions.end());
    for (size_t i = 0; i < dimensions.size(); ++i) {
        if (dimensions[i].is_any()) continue;
        Dimensions tried = dimensions;
        tried[i] = Dimension::any();
        if (!goes_with(tried)) continue;
        for (const Dimension expected : candidates) {
            if (expected.is_any() || expected == dimensions[i]) continue;
            tried[i] = expected;
            if (!goes_with(tried)) continue;
            const std::string which = expected.is_plain() ? "" : " as argument " + std::to_string(i + 1);
            report_expected(name + "() expects", *values[i], expected, dimensions[i], which);
            return;
        }
    }
    Dimensions plain = dimensions;
    for (Dimension& dimension : plain)
        if (!dimension.is_any()) dimension = Dimension::plain();
    const bool wants_plain = plain != dimensions && goes_with(plain);
    if (auto finding = report(e.span, name + (wants_plain ? "() expects plain numbers, got " : "() does not go with ") +
                                          description(dimensions)))
        finding->hint = "divide lengths by a wavelength";
}

} // namespace haptel::lang
