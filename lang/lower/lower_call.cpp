// Calls, and the functions they reach.
#include "lang/abi/outputs.h"
#include "lang/ir/op_info.h"
#include "lang/lower/lowering.h"
#include "lang/program/scope.h"

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

// What is passed by value, as parameters of the function; nothing where it is only written.
std::vector<Values> declared(ir::Builder& builder, const std::vector<ParameterInfo>& parameters)
{
    std::vector<const ParameterInfo*> values;
    for (const ParameterInfo& parameter : parameters)
        if (!parameter.is_function) values.push_back(&parameter);
    std::vector<Values> arguments(values.size());
    uint32_t& first_size = builder.function().first_argument_size;
    for (const bool are_images : images_last)
        for (size_t p = 0; p < values.size(); ++p) {
            const Type type = values[p]->type;
            if ((type == image_type) != are_images || values[p]->passing == Passing::out) continue;
            if (first_size == 0 && !are_images) first_size = type.components();
            for (const ir::Type part : ir_types(type)) arguments[p].push_back(builder.parameter(part));
        }
    return arguments;
}

uint32_t reads_of(const FunctionReference& reference)
{
    auto source = std::get_if<const FunctionInfo*>(&reference);
    return source ? (*source)->reads : 0;
}

} // namespace

// ---- in a body

FunctionReference BodyLowering::resolved(const FunctionReference& reference) const
{
    if (auto parameter = std::get_if<const Symbol*>(&reference)) return functions[(*parameter)->slot];
    return reference;
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
    const FunctionReference callee = resolved(target.function);
    const std::vector<ParameterInfo>& parameters = std::holds_alternative<const FunctionInfo*>(callee)
                                                       ? std::get<const FunctionInfo*>(callee)->parameters
                                                       : std::get<const BuiltinOverload*>(callee)->parameters;
    std::vector<Values> values;
    std::vector<FunctionReference> passed;
    for (size_t i = 0; i < arguments.size(); ++i) {
        if (parameters[i].is_function)
            passed.push_back(resolved(target.function_arguments[i]));
        else if (parameters[i].passing != Passing::out)
            values.push_back(converted(*arguments[i], parameters[i].type));
    }
    builder.span = here;
    if (auto builtin = std::get_if<const BuiltinOverload*>(&callee); builtin && order == 0)
        return lower_builtin(owner, builder, **builtin, values);

    if (owner.is_too_large(here)) return zeros(e.type);
    const LoweredFunction function = owner.function(callee, passed, order);
    Values flat;
    for (const bool are_images : images_last)
        for (const Values& value : values)
            if ((builder.type(value[0]) == ir::Type::image) == are_images)
                flat.insert(flat.end(), value.begin(), value.end());
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

LoweredFunction ModuleLowering::function(const FunctionReference& reference,
                                         const std::vector<FunctionReference>& passed, uint32_t order)
{
    Key key{{identity(reference)}, order};
    for (const FunctionReference& argument : passed) key.functions.push_back(identity(argument));
    if (const auto known = functions.find(key); known != functions.end()) return known->second;
    LoweredFunction made;
    if (order > 0)
        made = make_derivative(function(reference, passed, order - 1));
    else if (auto source = std::get_if<const FunctionInfo*>(&reference))
        made = make(**source, passed);
    else
        made = make(*std::get<const BuiltinOverload*>(reference));
    functions[key] = made;
    return made;
}

LoweredFunction ModuleLowering::make(const FunctionInfo& info, const std::vector<FunctionReference>& passed)
{
    std::string name = signature_of(info);
    LoweredFunction made;
    made.reads = info.reads;
    if (!passed.empty()) {
        std::string list;
        for (const FunctionReference& argument : passed) {
            list += (list.empty() ? "" : ",") + name_of(argument);
            made.reads |= reads_of(argument);
        }
        name.insert(info.name.size(), "<" + list + ">");
    }
    BodyLowering body(*this, unique(std::move(name)), info.slot_count);
    ir::Function& function = body.builder.function();
    body.value_parameters(declared(body.builder, info.parameters));
    body.input_parameters(made.reads);
    body.bind_functions(passed);
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
    const std::vector<Values> arguments = declared(builder, overload.parameters);
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
    const Type element = symbol.type.element();
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
