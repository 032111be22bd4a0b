// Calls, and the functions they reach.
#include "lang/abi/outputs.h"
#include "lang/ir/op_info.h"
#include "lang/lower/lowering.h"
#include "lang/program/scope.h"
#include "lang/text/limits.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;
using ir::Value;

namespace {

constexpr uint32_t depth_max = 256;
constexpr size_t value_count_max = 250'000;

// Functions of the IR take images behind their other arguments: derivatives and facts are with respect to the first
// ones.
constexpr bool images_last[] = {false, true};

// The parameters that are values, as the IR takes them: `by` first, images last.
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

// What is passed by value, as parameters of the function, by parameter; nothing where it is only written.
std::vector<Values> declared(ir::Builder& builder, const std::vector<ParameterInfo>& parameters, size_t by)
{
    std::vector<Values> arguments(parameters.size());
    uint32_t& first_size = builder.function().first_argument_size;
    for (const size_t p : in_order(parameters, by)) {
        const Type type = parameters[p].type;
        if (first_size == 0 && type != image_type) first_size = type.components();
        for (const ir::Type part : ir_types(type)) arguments[p].push_back(builder.parameter(part));
    }
    return arguments;
}

} // namespace

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

// ---- in the module

bool ModuleLowering::is_too_large(Span span, size_t under_work)
{
    for (; counted_functions < module.functions.size(); ++counted_functions)
        value_count += module.functions[counted_functions].value_types.size();
    if (value_count + under_work <= value_count_max) return false;
    if (!reported_size)
        diagnostics.error(span, "too-large",
                          "this program grows beyond " + std::to_string(value_count_max) + " values here",
                          "a function is made anew for each function that is passed to it and each derivative of it");
    reported_size = true;
    return true;
}

LoweredFunction ModuleLowering::function(const BoundFunction& function, uint32_t order, size_t by)
{
    if (order == 0) by = SIZE_MAX;
    Key key{order, by};
    key.push_back(reinterpret_cast<uintptr_t>(identity(function.function)));
    for (const BoundFunction& passed : function.functions) passed.add_key(key);
    if (const auto known = functions.find(key); known != functions.end()) return known->second;
    LoweredFunction made;
    if (order > 1)
        made = make_derivative(this->function(function, order - 1, by));
    else if (order > 0)
        made = make_derivative(make_by(function, by));
    else if (auto source = std::get_if<const FunctionInfo*>(&function.function))
        made = make(**source, function.functions);
    else
        made = make(*std::get<const BuiltinOverload*>(function.function));
    functions[key] = made;
    return made;
}

// The function with the parameter `by` in the first place, where derivatives are by.
LoweredFunction ModuleLowering::make_by(const BoundFunction& function, size_t by)
{
    const LoweredFunction of = this->function(function);
    const std::vector<ParameterInfo>& parameters = function.parameters();
    const std::vector<size_t> order = in_order(parameters, by);
    if (order == in_order(parameters, SIZE_MAX)) return of;
    ir::Builder builder(module, unique(module.functions[of.index].name + " by " + parameters[by].name));
    const std::vector<Values> values = declared(builder, parameters, by);
    Values flat;
    for (const size_t i : in_order(parameters, SIZE_MAX)) flat.insert(flat.end(), values[i].begin(), values[i].end());
    const ir::Function& source = module.functions[of.index];
    for (size_t i = flat.size(); i < source.parameters.size(); ++i)
        flat.push_back(builder.parameter(source.type(source.parameters[i])));
    builder.function().is_library = source.is_library;
    return {builder.finish(builder.call(of.index, flat)), of.reads, of.depth + 1};
}

LoweredFunction ModuleLowering::make(const FunctionInfo& info, const std::vector<BoundFunction>& passed)
{
    std::string name = signature_of(info);
    LoweredFunction made;
    made.reads = info.reads;
    if (!passed.empty()) {
        std::string list;
        for (const BoundFunction& argument : passed) {
            list += (list.empty() ? "" : ",") + argument.name();
            made.reads |= argument.reads();
        }
        name.insert(info.name.size(), "<" + list + ">");
    }
    BodyLowering body(*this, unique(std::move(name)), info.slot_count);
    ir::Function& function = body.builder.function();
    std::vector<Values> arguments = declared(body.builder, info.parameters, SIZE_MAX);
    for (size_t i = info.parameters.size(); i-- > 0;)
        if (info.parameters[i].is_function) arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i));
    body.value_parameters(std::move(arguments));
    body.bind_functions(passed);
    body.input_parameters(made.reads);
    function.is_library = info.is_library;
    if (info.tree->facts && info.result != void_type)
        function.facts.assign(info.result.components(), *info.tree->facts);
    for (ir::Facts& facts : function.facts) facts.proven = info.is_library;
    for (const ParameterInfo& parameter : info.parameters)
        if (parameter.passing == Passing::out && parameter.symbol && info.is_texture)
            body.variable(*parameter.symbol) =
                Values(parameter.type.components(), body.builder.real(find_output(parameter.name)->value));
        else if (parameter.passing == Passing::out && parameter.symbol)
            body.clear(*parameter.symbol);
        else if (parameter.held && parameter.symbol)
            body.hold(*parameter.symbol, *parameter.held);
    Values results = body.whole_body(*info.tree->body, info.result);
    for (const ParameterInfo& parameter : info.parameters) {
        if (!parameter.is_written()) continue;
        const Values more = parameter.symbol ? body.variable(*parameter.symbol) : body.zeros(parameter.type);
        results.insert(results.end(), more.begin(), more.end());
    }
    made.index = body.builder.finish(results);
    made.depth = body.depth;
    return made;
}

// A built-in as a function, to be passed or differentiated.
LoweredFunction ModuleLowering::make(const BuiltinOverload& overload)
{
    ir::Builder builder(module, unique(to_string(Candidate(overload))));
    builder.function().is_library = true;
    const std::vector<Values> arguments = declared(builder, overload.parameters, SIZE_MAX);
    return {builder.finish(lower_builtin(*this, builder, overload, arguments)), 0, 0};
}

uint32_t ModuleLowering::smooth_ramp()
{
    if (ramp) return *ramp;
    ir::Builder builder(module, unique("smooth ramp"));
    const Value x = builder.parameter(ir::Type::real), zero = builder.real(0), one = builder.real(1);
    const auto make = [&](ir::Op op, Value a, Value b) { return builder.operation(op, {a, b}); };
    const Value t = make(ir::Op::min, make(ir::Op::max, x, zero), one);
    const Value slant = make(ir::Op::sub, builder.real(3), make(ir::Op::mul, builder.real(2), t));
    ir::Function& function = builder.function();
    function.first_argument_size = 1;
    function.is_library = true;
    // |6 t (1 - t)| is 3/2 at 1/2, |6 - 12 t| is 6 at the ends, where the second derivative jumps to 0
    function.facts = {{0.0, 1.0, 1.5, 6.0, ir::Continuity::c1, true, {}}};
    ramp = builder.finish(std::vector<Value>{make(ir::Op::mul, make(ir::Op::mul, t, t), slant)});
    return *ramp;
}

// A function of the same parameters that returns the derivatives alone, direction after direction: of a vector by a
// vector the matrix whose column j is the derivative by component j.
LoweredFunction ModuleLowering::make_derivative(const LoweredFunction& of)
{
    const ir::Derivative derivative = differentiator.jacobian(of.index);
    const ir::Function& source = module.functions[of.index];
    ir::Builder builder(module, unique("grad " + source.name));
    Values arguments;
    for (ir::Value parameter : source.parameters) arguments.push_back(builder.parameter(source.type(parameter)));
    builder.function().first_argument_size = source.first_argument_size;
    builder.function().is_library = source.is_library;
    const Values results = builder.call(derivative.function, arguments);
    size_t next = derivative.exists.size(); // behind the values: by result, then direction
    const size_t rows = derivative.exists.size(), columns = derivative.exists.front().size();
    Values tangents(rows * columns);
    for (size_t row = 0; row < rows; ++row)
        for (size_t column = 0; column < columns; ++column)
            tangents[column * rows + row] = derivative.exists[row][column] ? results[next++] : builder.real(0);
    return {builder.finish(tangents), of.reads, of.depth + 1};
}

const std::vector<uint32_t>& ModuleLowering::tables(const Symbol& symbol)
{
    std::vector<uint32_t>& made = component_tables[&symbol];
    if (!made.empty()) return made;
    const Type element = symbol.type.cell();
    const std::vector<ir::Type> types = ir_types(element);
    for (uint32_t component = 0; component < element.components(); ++component) {
        ir::Table table;
        table.name = unique(element.is_vector()    ? symbol.name + "." + "xyzw"[component]
                            : !element.is_scalar() ? symbol.name + "." + std::to_string(component)
                                                   : symbol.name);
        table.element = types[component] == ir::Type::boolean ? ir::Type::i32 : types[component];
        for (size_t cell = component; cell < symbol.value.size(); cell += element.components()) {
            const ConstantPart& part = symbol.value[cell];
            if (auto real = std::get_if<double>(&part))
                table.reals.push_back(*real);
            else if (auto truth = std::get_if<bool>(&part))
                table.words.push_back(*truth);
            else
                table.words.push_back(std::get<uint32_t>(part));
        }
        made.push_back(static_cast<uint32_t>(module.tables.size()));
        module.tables.push_back(std::move(table));
    }
    return made;
}

std::string ModuleLowering::unique(std::string name)
{
    const uint32_t count = ++names[name];
    return count == 1 ? name : name + " #" + std::to_string(count);
}

} // namespace haptel::lang
