// Functions and tables of the module, each made once: from source, of built-in functions, and derivatives of either.
#include "lang/abi/outputs.h"
#include "lang/lower/lowering.h"
#include "lang/program/scope.h"

namespace haptel::lang {

using namespace ast;
using ir::Value;

namespace {

constexpr size_t value_count_max = 250'000;

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
