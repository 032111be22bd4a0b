// Calls, and functions with what is bound to them.
#include "lang/lower/lowering.h"
#include "lang/program/scope.h"
#include "lang/text/limits.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;
using ir::Value;

namespace {

constexpr uint32_t depth_max = 256;

// Functions of the IR take images behind their other arguments: derivatives and facts are with respect to the first
// ones.
constexpr bool images_last[] = {false, true};

// The first parameter that is a number and not bound: what a derivative is by.
size_t first_number(const BoundFunction& function)
{
    const std::vector<ParameterInfo>& parameters = function.parameters();
    size_t i = 0;
    while (i < parameters.size() &&
           (parameters[i].is_function || parameters[i].type == image_type || function.is_bound(i)))
        ++i;
    return i;
}

} // namespace

std::vector<size_t> in_order(const std::vector<ParameterInfo>& parameters, size_t by)
{
    std::vector<size_t> order;
    const auto add = [&](size_t i, bool are_images) {
        const ParameterInfo& parameter = parameters[i];
        const bool is_value = !parameter.is_function && parameter.passing != Passing::out;
        if (is_value && (parameter.type == image_type) == are_images) order.push_back(i);
    };
    if (by < parameters.size()) add(by, false);
    for (const bool are_images : images_last)
        for (size_t i = 0; i < parameters.size(); ++i)
            if (i != by || are_images) add(i, are_images);
    return order;
}

// ---- functions with what is bound to them

const std::vector<ParameterInfo>& BoundFunction::parameters() const
{
    if (auto source = std::get_if<const FunctionInfo*>(&function)) return (*source)->parameters;
    return std::get<const BuiltinOverload*>(function)->parameters;
}

void BoundFunction::add_values(Values& flat) const
{
    for (const Values& value : values) flat.insert(flat.end(), value.begin(), value.end());
    for (const BoundFunction& inner : functions) inner.add_values(flat);
}

void BoundFunction::add_key(std::vector<uintptr_t>& key) const
{
    key.push_back(reinterpret_cast<uintptr_t>(identity(function)));
    for (size_t i = 0; i < values.size(); ++i)
        if (is_bound(i)) key.push_back(i + 1);
    key.push_back(0);
    for (const BoundFunction& inner : functions) inner.add_key(key);
}

uint32_t BoundFunction::reads() const
{
    auto source = std::get_if<const FunctionInfo*>(&function);
    uint32_t all = source ? (*source)->reads : 0;
    for (const BoundFunction& inner : functions) all |= inner.reads();
    return all;
}

size_t BoundFunction::size() const
{
    size_t all = 1;
    for (const Values& value : values) all += value.size();
    for (const BoundFunction& inner : functions) all += inner.size();
    return all;
}

// "cellular(_,=)"
std::string BoundFunction::name() const
{
    std::string list;
    size_t inner = 0;
    const std::vector<ParameterInfo>& all = parameters();
    for (size_t i = 0; i < all.size(); ++i)
        list += (i > 0 ? "," : "") + (all[i].is_function ? functions[inner++].name() : is_bound(i) ? "=" : "_");
    const bool is_all_open = list.find_first_not_of("_,") == list.npos;
    return name_of(function) + (is_all_open ? "" : "(" + list + ")");
}

// ---- in a body

BoundFunction BodyLowering::resolved(const FunctionReference& reference)
{
    if (auto parameter = std::get_if<const Symbol*>(&reference)) return functions[(*parameter)->slot];
    auto bound = std::get_if<const CallExpression*>(&reference);
    if (!bound) return {reference};
    BoundFunction made = resolved((*bound)->target.function);
    bind(made, (*bound)->target, (*bound)->arguments);
    return made;
}

// The arguments stand for what is not bound yet, and are computed where they stand.
void BodyLowering::bind(BoundFunction& function, const CallTarget& target, const std::vector<ExpressionPtr>& arguments)
{
    const std::vector<ParameterInfo>& parameters = function.parameters();
    const bool has_functions = !function.functions.empty();
    function.values.resize(parameters.size());
    size_t at = 0;
    for (size_t i = 0; i < parameters.size(); ++i) {
        const ParameterInfo& parameter = parameters[i];
        if (parameter.is_function ? has_functions : function.is_bound(i)) continue;
        const Expression& argument = *arguments[at];
        if (parameter.is_function)
            function.functions.push_back(resolved(target.function_arguments[at]));
        else if (parameter.passing != Passing::out && (target.is_open.empty() || !target.is_open[at]))
            function.values[i] = converted(argument, parameter.type);
        ++at;
    }
}

void BodyLowering::bind_functions(const std::vector<BoundFunction>& passed)
{
    functions = passed;
    for (BoundFunction& function : functions) make_parameters(function);
}

void BodyLowering::make_parameters(BoundFunction& function)
{
    for (size_t i = 0; i < function.values.size(); ++i) {
        const std::vector<ir::Type> types = ir_types(function.parameters()[i].type);
        for (size_t part = 0; part < function.values[i].size(); ++part)
            function.values[i][part] = builder.parameter(types[part]);
    }
    for (BoundFunction& inner : function.functions) make_parameters(inner);
}

Values BodyLowering::lower(const Expression& e, const CallExpression& node)
{
    if (node.target.is_constructor) return constructor(e, node);
    builder.span = e.span;
    return call(e, node.target, node.arguments, 0, node.inputs);
}

Values BodyLowering::lower(const Expression& e, const GradCall& node)
{
    builder.span = e.span;
    return call(e, node.target, node.arguments, node.order);
}

Values BodyLowering::constructor(const Expression& e, const CallExpression& node)
{
    const Type from = node.arguments[0]->type;
    Values parts;
    for (size_t i = 0; e.type.is_struct() && i < node.arguments.size(); ++i) {
        const Values more = converted(*node.arguments[i], e.type.structure->members[i].type);
        parts.insert(parts.end(), more.begin(), more.end());
    }
    if (e.type.is_struct()) return parts;
    for (const ExpressionPtr& argument : node.arguments) {
        const Values more = convert(expression(*argument), argument->type, {e.type.scalar});
        parts.insert(parts.end(), more.begin(), more.end());
    }
    if (e.type.is_matrix() && (from.is_matrix() || parts.size() == 1)) {
        Values made; // the unit matrix or the number times it, with the given part inside
        for (uint8_t column = 0; column < e.type.size; ++column)
            for (uint8_t row = 0; row < e.type.size; ++row) {
                const bool is_given = row < from.size && column < from.size && from.is_matrix();
                const bool is_diagonal = row == column;
                made.push_back(is_given           ? parts[size_t{column} * from.size + row]
                               : !is_diagonal     ? builder.real(0)
                               : from.is_matrix() ? builder.real(1)
                                                  : parts[0]);
            }
        return made;
    }
    if (parts.size() == 1) parts.resize(e.type.components(), parts[0]);
    parts.resize(e.type.components());
    return parts;
}

Values BodyLowering::call(const Expression& e, const CallTarget& target, const std::vector<ExpressionPtr>& arguments,
                          uint32_t order, GivenInputs given)
{
    const Span here = builder.span;
    BoundFunction callee = resolved(target.function);
    const std::vector<ParameterInfo>& parameters = callee.parameters();
    const size_t by = first_number(callee);
    bind(callee, target, arguments);
    builder.span = here;
    auto builtin = std::get_if<const BuiltinOverload*>(&callee.function);
    if (builtin && order == 0) return lower_builtin(owner, builder, **builtin, callee.values);

    if (owner.is_too_large(here)) return zeros(e.type);
    if (callee.size() > bound_max) {
        owner.diagnostics.error(here, "too-large",
                                "the functions that are passed here have more than " + std::to_string(bound_max) +
                                    " functions and numbers bound to them",
                                "a function that is bound to two others is there twice");
        return zeros(e.type);
    }
    const LoweredFunction function = owner.function(callee, order, by);
    Values flat;
    for (const size_t i : in_order(parameters, order > 0 ? by : SIZE_MAX))
        flat.insert(flat.end(), callee.values[i].begin(), callee.values[i].end());
    for (const BoundFunction& passed : callee.functions) passed.add_values(flat);
    for (uint32_t name = 0; name < input_name_count; ++name) {
        if (!(function.reads >> name & 1)) continue;
        const auto own = std::ranges::find(given, static_cast<InputName>(name), [](auto& one) { return one.first; });
        const Values parts = own == given.end() ? input(static_cast<InputName>(name))
                                                : converted(*own->second, vec(builtin_inputs[name].size));
        flat.insert(flat.end(), parts.begin(), parts.end());
    }
    depth = std::max(depth, region_depth + 1 + function.depth);
    if (depth > depth_max) {
        owner.diagnostics.error(here, "too-deep",
                                "calls, ifs and loops nest more than " + std::to_string(depth_max) + " deep here");
        depth = 0; // once is enough
    }
    for (size_t i = 0; i < arguments.size() && order == 0; ++i)
        if (parameters[i].is_written()) locate(*arguments[i]);
    Values results = builder.call(function.index, flat);
    const size_t returned = e.type == void_type ? 0 : e.type.components();
    std::span<const Value> written(results.begin() + static_cast<std::ptrdiff_t>(returned), results.end());
    for (size_t i = 0; i < arguments.size() && order == 0; ++i) {
        if (!parameters[i].is_written()) continue;
        const size_t size = parameters[i].type.components();
        if (!std::holds_alternative<LeftOut>(arguments[i]->node))
            store(*arguments[i], Values(written.begin(), written.begin() + static_cast<std::ptrdiff_t>(size)));
        written = written.subspan(size);
    }
    located.clear();
    if (order == 0) results.resize(returned);
    return results;
}

} // namespace haptel::lang
