// Dimensions of calls: by the rules of what is built in, by looking into what is written.
#include "lang/check/dimension/dimension_checker.h"
#include "lang/check/dimension/dimension_rules.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

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

FunctionReference DimensionBody::resolved(const FunctionReference& reference) const
{
    auto parameter = std::get_if<const Symbol*>(&reference);
    if (!parameter) return reference;
    return (*parameter)->slot < functions.size() ? functions[(*parameter)->slot] : FunctionReference{};
}

Dimension DimensionBody::constructor(const Expression& e, const CallExpression& node)
{
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
    const FunctionReference callee = resolved(target.function);
    auto source = std::get_if<const FunctionInfo*>(&callee);
    FunctionReferences passed;
    Dimensions dimensions;
    std::vector<const Expression*> values;
    for (size_t i = 0; i < arguments.size(); ++i) {
        if (!std::holds_alternative<std::monostate>(target.function_arguments[i])) {
            passed.push_back(resolved(target.function_arguments[i]));
            continue;
        }
        const bool counts = source && (*source)->parameters[i].type.scalar != Scalar::float_;
        const Dimension found = expression(*arguments[i]);
        values.push_back(arguments[i].get());
        dimensions.push_back(counts ? Dimension::plain() : found);
    }

    Dimension result = Dimension::any();
    if (auto overload = std::get_if<const BuiltinOverload*>(&callee)) {
        auto written = std::get_if<CallExpression>(&e.node);
        const bool is_power = (*overload)->builtin->id == BuiltinId::pow && written;
        if (is_power && !dimensions[0].is_any() && !dimensions[0].is_plain()) return power(*written, dimensions);
        result = built_in(name, **overload, dimensions, values);
    } else if (source) {
        const Span outer = owner.user_call;
        if (!is_library) owner.user_call = e.span;
        DimensionInstance& made = owner.function(**source, passed, dimensions);
        instance.callees.push_back(&made);
        if (made.is_at_fault && is_library)
            instance.is_at_fault = true;
        else if (made.is_at_fault)
            blame_call(e, name, **source, passed, dimensions, values);
        owner.user_call = outer;
        result = made.result;
    }
    const auto is_number = [](const Expression* value) { return value->type != image_type; };
    const auto by = std::find_if(values.begin(), values.end(), is_number) - values.begin(); // a derivative's
    for (uint32_t i = 0; i < order; ++i) result = result / dimensions[static_cast<size_t>(by)];
    return result;
}

// pow(x, 1.5) of a length is a length to the 1.5; nothing if the exponent is not known.
Dimension DimensionBody::power(const CallExpression& node, const Dimensions& dimensions)
{
    const Expression &base = *node.arguments[0], &exponent = *node.arguments[1];
    if (!join(dimensions[1], Dimension::plain()))
        report_expected("pow() expects", exponent, Dimension::plain(), dimensions[1], " as its exponent");
    const auto number = constant_exponent(owner.constant_values, exponent);
    const auto fraction = number ? exponent_near(*number) : std::nullopt;
    if (fraction) return dimensions[0].power(*fraction);
    report_expected("pow() expects", base, Dimension::plain(), dimensions[0], " where its exponent is not constant");
    return Dimension::any();
}

Dimension DimensionBody::built_in(const std::string& name, const BuiltinOverload& overload,
                                  const Dimensions& dimensions, const std::vector<const Expression*>& values)
{
    const BuiltinId id = overload.builtin->id;
    const DimensionResult made = apply_rule(id, dimensions);
    const Dimension found = made.fits ? Dimension::any() : dimensions[made.argument];
    if (!made.fits && made.by_letter) {
        const auto wrong = values.begin() + made.argument;
        const auto bare = std::find_if(values.begin(), wrong, [](auto* value) { return bare_number(*value); });
        const bool mends_earlier = bare != wrong && made.expected.is_plain();
        report((*wrong)->span,
               name + "() expects numbers of one dimension, got " + description(made.expected) + " and " +
                   description(found),
               mends_earlier ? proposal(**bare, found, made.expected) : proposal(**wrong, made.expected, found));
    } else if (!made.fits) {
        report_expected(name + "() expects", *values[made.argument], made.expected, found);
    }
    if (id == BuiltinId::determinant) return dimensions[0].power({overload.parameters.front().type.size, 1});
    return made.result;
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
    report(e.span,
           name + (wants_plain ? "() expects plain numbers, got " : "() does not go with ") + description(dimensions),
           {"divide lengths by a wavelength"});
}

} // namespace haptel::lang
