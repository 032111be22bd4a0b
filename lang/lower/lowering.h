// The two classes that lowering is made of: ModuleLowering makes functions and tables once each, BodyLowering turns one
// body into instructions. Parts of the former: lower.cpp, lower_function.cpp; of the latter: lower_expression.cpp,
// lower_operator.cpp, lower_call.cpp, lower_builtin.cpp, lower_statement.cpp.
#pragma once

#include "lang/ir/builder.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/program/builtins.h"
#include "lang/program/checked_program.h"
#include "lang/program/completion.h"
#include "lang/text/diagnostic.h"

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace haptel::lang {

// The components of a value.
using Values = std::vector<ir::Value>;

// A function that is called or passed, in the body at hand: of the source or built in, with those of its arguments that
// are bound. Whoever makes the function that it is passed to adds them behind that one's own arguments.
struct BoundFunction {
    FunctionReference function = {};
    std::vector<Values> values = {};           // by parameter; none: it is open, only written, or a function
    std::vector<BoundFunction> functions = {}; // what its parameters are that are functions

    const std::vector<ParameterInfo>& parameters() const;
    bool is_bound(size_t parameter) const { return parameter < values.size() && !values[parameter].empty(); }
    // Of itself and of what is bound to it: the values one behind the other, and what tells it from others.
    void add_values(Values& flat) const;
    void add_key(std::vector<uintptr_t>& key) const;
    uint32_t reads() const;
    size_t size() const; // in functions and values
    std::string name() const;
};

struct LoweredFunction {
    uint32_t index = 0;
    uint32_t reads = 0; // HAPTEL_READS_*: inputs that are passed behind the arguments, in the order of the bits
    uint32_t depth = 0; // regions and calls inside each other, at most
};

// Counts how deep the lowering itself is in recursion.
class Nesting {
public:
    explicit Nesting(uint32_t& counter) : depth(counter) { ++depth; }
    ~Nesting() { --depth; }
    Nesting(const Nesting&) = delete;

private:
    uint32_t& depth;
};

// By InputName: the first of its components.
inline constexpr ir::Input first_input[input_name_count] = {
    ir::Input::p_x,          ir::Input::n_x,         ir::Input::uv_x,      ir::Input::time,
    ir::Input::center_x,     ir::Input::extent_x,    ir::Input::footprint, ir::Input::velocity_x,
    ir::Input::normal_force, ir::Input::tool_radius, ir::Input::tangent_x, ir::Input::bitangent_x,
    ir::Input::curvature};

class ModuleLowering {
public:
    ModuleLowering(ir::Module& target, Diagnostics& sink) : module(target), diagnostics(sink), differentiator(target) {}

    // What the values of `function` are does not matter. `order` counts derivatives with respect to the parameter `by`,
    // which stands first then.
    LoweredFunction function(const BoundFunction& function, uint32_t order = 0, size_t by = 0);
    void texture(const CheckedTexture& texture);
    bool refuse_contact(const ir::Texture& texture);
    // One table per component of the elements.
    const std::vector<uint32_t>& tables(const Symbol& symbol);

    // 0 up to 0, 1 from 1 on, 3 t^2 - 2 t^3 between: what smoothstep is made of, as a function that tells its facts.
    uint32_t smooth_ramp();

    // Derivatives and functions as arguments can multiply code: reports, once, when there is too much.
    bool is_too_large(Span span, size_t under_work = 0);

    ir::Module& module;
    Diagnostics& diagnostics;
    uint32_t nesting = 0; // of the lowering itself, over all bodies under work

private:
    using Key = std::vector<uintptr_t>;
    LoweredFunction make(const FunctionInfo& info, const std::vector<BoundFunction>& passed);
    LoweredFunction make(const BuiltinOverload& overload);
    LoweredFunction make_by(const BoundFunction& function, size_t by);
    LoweredFunction make_derivative(const LoweredFunction& of);
    std::string unique(std::string name);

    std::map<Key, LoweredFunction> functions;
    std::map<const Symbol*, std::vector<uint32_t>> component_tables;
    std::map<std::string, uint32_t> names;
    std::optional<uint32_t> ramp;
    size_t value_count = 0, counted_functions = 0; // of those made so far
    bool reported_size = false;
    ir::Differentiator differentiator;
};

class BodyLowering {
public:
    BodyLowering(ModuleLowering& owner, std::string name, uint32_t slot_count);

    // Parameters first: values, then inputs. A texture has neither: it reads.
    void value_parameters(std::vector<Values> arguments) { std::ranges::move(arguments, variables.begin()); }
    void input_parameters(uint32_t reads);
    // What is bound to them become parameters.
    void bind_functions(const std::vector<BoundFunction>& passed);
    Values& variable(const Symbol& local) { return variables[local.slot]; }
    void clear(const Symbol& local) { variables[local.slot] = zeros(local.type); }
    void hold(const Symbol& local, ir::IntRange range); // a whole number, whatever it was given
    Values zeros(Type type);                            // none of void

    Values whole_body(const ast::Statement& body, Type result);
    Values converted(const ast::Expression& e, Type to);

    ir::Builder builder;
    uint32_t depth = 0; // LoweredFunction::depth

private:
    // ---- expressions
    Values expression(const ast::Expression& e);
    Values lower(const ast::Expression& e, const ast::ErrorExpression& node);
    Values lower(const ast::Expression& e, const ast::NumberLiteral& node);
    Values lower(const ast::Expression& e, const ast::BoolLiteral& node);
    Values lower(const ast::Expression& e, const ast::NameExpression& node);
    Values lower(const ast::Expression& e, const ast::Unary& node);
    Values lower(const ast::Expression& e, const ast::Chain& node);
    Values lower(const ast::Expression& e, const ast::Conditional& node);
    Values lower(const ast::Expression& e, const ast::CallExpression& node);
    Values lower(const ast::Expression& e, const ast::GradCall& node);
    Values lower(const ast::Expression& e, const ast::Member& node);
    Values lower(const ast::Expression& e, const ast::Index& node);
    Values lower(const ast::Expression& e, const ast::BraceList& node);
    Values lower(const ast::Expression&, const ast::LeftOut& node)
    {
        return constant(node.parameter->value_parts, node.parameter->type);
    }
    Values convert(const Values& parts, Type from, Type to);
    Values binary(ast::BinaryOp op, const Values& a, Type a_type, const Values& b, Type b_type);
    Values cell(const Symbol& table, ir::Value row, ir::Value column);
    Values linear_product(const Values& left, const Values& right, size_t size);
    ir::Value binary_scalar(ast::BinaryOp op, ir::Value a, ir::Value b);
    ir::Value integer(ir::Op op, ir::Value a, ir::Value b); // signed operation, on the bits where operands are u32
    ir::Value held(ir::Value value, ir::IntRange range);
    ir::Value index_within(const ast::Expression& index, uint32_t size);
    void locate(const ast::Expression& target);
    Values input(InputName name);
    Values constant(std::span<const ConstantPart> parts, Type type);
    bool too_deep(Span span);

    // ---- calls
    using GivenInputs = std::span<const std::pair<InputName, ast::ExpressionPtr>>;
    Values call(const ast::Expression& e, const CallTarget& target, const std::vector<ast::ExpressionPtr>& arguments,
                uint32_t order, GivenInputs given = {});
    Values constructor(const ast::Expression& e, const ast::CallExpression& node);
    BoundFunction resolved(const FunctionReference& reference);
    void bind(BoundFunction& function, const CallTarget& target, const std::vector<ast::ExpressionPtr>& arguments);
    void make_parameters(BoundFunction& function);

    // ---- statements. Besides the variables four more slots hold the flow: whether the function has returned, with
    // what, whether the loop was left, and whether this turn of it is over.
    using Statements = std::span<const ast::StatementPtr>;
    using Slots = std::vector<uint32_t>;
    void sequence(Statements statements);
    void statement(const ast::Statement& s, Statements rest);
    void lower(const ast::Declaration& node);
    void lower(const ast::Assignment& node);
    void store(const ast::Expression& target, const Values& value);
    void lower(const ast::For& node);
    void turns(const ast::For& node, ir::Value trips, const std::function<ir::Value(ir::Value turn)>& counter);
    void branch(const ast::If& node, size_t arm, Statements rest, const Slots& changed);
    void lower(const ast::Switch& node, const ast::Statement& s, Statements rest);
    void cases(std::span<const ast::Switch::Case* const> all, ir::Value selector, Statements rest,
               const Slots& changed);
    void take(Statements arm, Statements rest, const Slots& changed);
    void choose(ir::Value condition, const Slots& changed, const std::function<void()>& then_arm,
                const std::function<void()>& else_arm);
    // Variables that the statements change, and what of the flow they can change.
    Slots changed_slots(const std::vector<const ast::Statement*>& statements, Completion ends) const;
    Values gather(const Slots& slots) const;
    void scatter(const Slots& slots, std::span<const ir::Value> parts);
    ir::Value left();
    uint32_t returned_slot() const { return static_cast<uint32_t>(variables.size()) - 4; }
    uint32_t result_slot() const { return static_cast<uint32_t>(variables.size()) - 3; }
    uint32_t broken_slot() const { return static_cast<uint32_t>(variables.size()) - 2; }
    uint32_t turned_slot() const { return static_cast<uint32_t>(variables.size()) - 1; }

    ModuleLowering& owner;
    std::vector<Values> variables;        // by Symbol::slot, then the four of the flow
    std::vector<BoundFunction> functions; // parameters that are functions, by Symbol::slot
    Values passed_inputs[input_name_count];
    std::map<const ast::Expression*, ir::Value> located; // indices of what a call is about to write
    Type result_type;
    uint32_t region_depth = 0;
};

// A built-in function of arguments that already have its parameters' types.
Values lower_builtin(ModuleLowering& owner, ir::Builder& builder, const BuiltinOverload& overload,
                     std::span<const Values> arguments);

ir::Type ir_type(Type type);               // of its components, which are of one type in all but structs
std::vector<ir::Type> ir_types(Type type); // of each of its components

// The parameters that are values, as the IR takes them: `by` first, images last.
std::vector<size_t> in_order(const std::vector<ParameterInfo>& parameters, size_t by);

} // namespace haptel::lang
