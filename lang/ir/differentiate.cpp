#include "lang/ir/differentiate.h"

#include "lang/abi.h"
#include "lang/ir/activity.h"
#include "lang/ir/builder.h"
#include "lang/ir/derivative_rules.h"

#include <algorithm>
#include <map>

namespace haptel::ir {
namespace {

constexpr size_t axes = 3; // directions of an entry's gradient: p_x, p_y, p_z

// dn/dp and duv/dp on the facet are inputs of their own.
Input input_derivative(Input input, size_t axis)
{
    auto row = [&](Input first, Input of) {
        size_t i = static_cast<size_t>(input) - static_cast<size_t>(of);
        return static_cast<Input>(static_cast<size_t>(first) + axes * i + axis);
    };
    return input <= Input::n_z ? row(Input::n_dp_00, Input::n_x) : row(Input::uv_dp_00, Input::uv_x);
}

bool input_is_active(Input input, size_t axis)
{
    if (input <= Input::p_z) return static_cast<size_t>(input) == axis;
    return input <= Input::uv_y;
}

// How the derivative of a callee is had at a call: by its Jacobian with respect to the `columns`, and the chain rule
// here, or by passing the tangents on, whatever needs fewer directions inside the callee.
struct CallPlan {
    std::vector<size_t> columns; // active arguments that a result depends on
    bool by_jacobian = true;
    Seeds seeds;
};

CallPlan plan_call(const Instruction& made, const Dependence& depends, const Activity& activity)
{
    CallPlan plan;
    for (size_t p = 0; p < made.operands.size(); ++p) {
        auto reads_it = [&](const std::vector<bool>& row) { return static_cast<bool>(row[p]); };
        if (activity.any(made.operands[p]) && std::any_of(depends.begin(), depends.end(), reads_it))
            plan.columns.push_back(p);
    }
    plan.by_jacobian = plan.columns.size() <= activity.directions();
    const size_t directions = plan.by_jacobian ? plan.columns.size() : activity.directions();
    plan.seeds.assign(made.operands.size(), std::vector<Seed>(directions, Seed::none));
    for (size_t column = 0; column < plan.columns.size(); ++column) {
        size_t p = plan.columns[column];
        if (plan.by_jacobian) {
            plan.seeds[p][column] = Seed::unit;
            continue;
        }
        for (size_t d = 0; d < directions; ++d)
            if (activity(made.operands[p], d)) plan.seeds[p][d] = Seed::given;
    }
    return plan;
}

// Copies a function into a builder, value by value, with the tangents beside.
class Emitter {
public:
    using FindDerivative = std::function<Derivative(uint32_t function, const Seeds&)>;

    Emitter(const Function& source, const Activity& active, Dependences& dependences, const FindDerivative& derivative)
        : function(source)
        , activity(active)
        , callees(dependences)
        , find_derivative(derivative)
        , primals(source.value_types.size())
        , tangents(source.value_types.size() * active.directions())
    {
    }

    void set_primal(Value value, Value made) { primals[value.index] = made; }
    void set_tangent(Builder& builder, Value value, size_t direction, Tangent made)
    {
        if (made && builder.real_constant(*made) == 0.0) made.reset(); // a known zero is no tangent
        tangents[value.index * activity.directions() + direction] = made;
    }
    Value primal(Value value) const { return primals[value.index]; }
    const Tangent& tangent(Value value, size_t direction) const
    {
        return tangents[value.index * activity.directions() + direction];
    }

    void emit(Builder& builder, const Block& block)
    {
        for (const Instruction& made : block.instructions) {
            builder.span = made.span;
            std::visit([&](const auto& kind) { copy(builder, made, kind); }, made.kind);
        }
    }

    // Asks for the derivative of every callee, so that none has to be made while this function is.
    void prepare(const Block& block)
    {
        std::vector<std::pair<uint32_t, Seeds>> wanted;
        collect(block, wanted);
        for (const auto& [callee, seeds] : wanted) find_derivative(callee, seeds);
    }

private:
    const Function& function;
    const Activity& activity;
    Dependences& callees;
    const FindDerivative& find_derivative;
    std::vector<Value> primals;    // by Value::index of the source
    std::vector<Tangent> tangents; // likewise, by direction

    std::vector<Value> primals_of(const std::vector<Value>& values, size_t first = 0) const
    {
        std::vector<Value> mapped;
        for (size_t i = first; i < values.size(); ++i) mapped.push_back(primal(values[i]));
        return mapped;
    }

    void collect(const Block& block, std::vector<std::pair<uint32_t, Seeds>>& wanted)
    {
        for (const Instruction& made : block.instructions) {
            if (auto* call = std::get_if<Call>(&made.kind)) {
                CallPlan plan = plan_call(made, callees.of(call->function), activity);
                if (!plan.columns.empty()) wanted.emplace_back(call->function, std::move(plan.seeds));
            }
            if (auto* choice = std::get_if<If>(&made.kind))
                for (const Block& arm : choice->arms) collect(arm, wanted);
            if (auto* loop = std::get_if<For>(&made.kind)) collect(loop->body[0], wanted);
        }
    }

    void copy(Builder& builder, const Instruction& made, const Operation& operation)
    {
        const Value result = made.results[0];
        std::vector<Value> operands = primals_of(made.operands);
        set_primal(result, builder.operation(operation.op, operands));
        if (function.type(result) != Type::real) return;
        std::vector<Tangent> of_operands(made.operands.size());
        for (size_t d = 0; d < activity.directions(); ++d) {
            if (!activity(result, d)) continue;
            for (size_t i = 0; i < made.operands.size(); ++i) of_operands[i] = tangent(made.operands[i], d);
            set_tangent(builder, result, d,
                        differentiate(builder, operation.op, operands, primal(result), of_operands));
        }
    }
    void copy(Builder& builder, const Instruction& made, const RealConstant& constant)
    {
        set_primal(made.results[0], builder.real(constant.value));
    }
    void copy(Builder& builder, const Instruction& made, const IntConstant& constant)
    {
        bool is_signed = function.type(made.results[0]) == Type::i32;
        set_primal(made.results[0],
                   is_signed ? builder.i32(static_cast<int32_t>(constant.bits)) : builder.u32(constant.bits));
    }
    void copy(Builder& builder, const Instruction& made, const BoolConstant& constant)
    {
        set_primal(made.results[0], builder.boolean(constant.value));
    }
    void copy(Builder& builder, const Instruction& made, const ReadInput& read)
    {
        const Value result = made.results[0];
        set_primal(result, builder.input(read.input));
        for (size_t d = 0; d < activity.directions(); ++d) {
            if (!activity(result, d)) continue;
            set_tangent(builder, result, d,
                        read.input <= Input::p_z ? builder.real(1) : builder.input(input_derivative(read.input, d)));
        }
    }
    void copy(Builder& builder, const Instruction& made, const ReadParameter& read)
    {
        set_primal(made.results[0], builder.texture_parameter(read.parameter, function.type(made.results[0])));
    }
    void copy(Builder& builder, const Instruction& made, const ReadTable& read)
    {
        set_primal(made.results[0], builder.table(read.table, primal(made.operands[0])));
    }

    void copy(Builder& builder, const Instruction& made, const Call& call)
    {
        CallPlan plan = plan_call(made, callees.of(call.function), activity);
        std::vector<Value> arguments = primals_of(made.operands);
        if (plan.columns.empty()) {
            std::vector<Value> results = builder.call(call.function, arguments);
            for (size_t r = 0; r < made.results.size(); ++r) set_primal(made.results[r], results[r]);
            return;
        }
        Derivative derivative = find_derivative(call.function, plan.seeds);
        for (size_t p = 0; p < plan.seeds.size(); ++p)
            for (size_t d = 0; d < plan.seeds[p].size(); ++d)
                if (plan.seeds[p][d] == Seed::given) arguments.push_back(made_tangent(builder, made.operands[p], d));
        std::vector<Value> results = builder.call(derivative.function, arguments);
        size_t next = made.results.size();
        for (size_t r = 0; r < made.results.size(); ++r) {
            set_primal(made.results[r], results[r]);
            std::vector<Tangent> row; // by direction of the callee
            for (bool exists : derivative.exists[r]) row.push_back(exists ? Tangent(results[next++]) : Tangent());
            for (size_t d = 0; d < activity.directions(); ++d)
                set_tangent(builder, made.results[r], d,
                            plan.by_jacobian ? chain(builder, row, made, plan.columns, d) : row[d]);
        }
    }

    Tangent chain(Builder& builder, const std::vector<Tangent>& row, const Instruction& made,
                  const std::vector<size_t>& columns, size_t direction)
    {
        Tangent sum;
        for (size_t column = 0; column < columns.size(); ++column) {
            const Tangent& inner = tangent(made.operands[columns[column]], direction);
            if (!row[column] || !inner) continue;
            Value product = builder.operation(Op::mul, {*row[column], *inner});
            sum = sum ? builder.operation(Op::add, {*sum, product}) : product;
        }
        return sum;
    }

    Value made_tangent(Builder& builder, Value value, size_t direction)
    {
        const Tangent& known = tangent(value, direction);
        return known ? *known : builder.real(0);
    }

    // The values, then the tangents of those that `like` has by activity.
    std::vector<Value> with_tangents(Builder& builder, const std::vector<Value>& values, size_t first,
                                     const std::vector<Value>& like)
    {
        std::vector<Value> all = primals_of(values, first);
        for (size_t i = 0; i < like.size(); ++i)
            for (size_t d = 0; d < activity.directions(); ++d)
                if (activity(like[i], d)) all.push_back(made_tangent(builder, values[first + i], d));
        return all;
    }
    void bind(Builder& builder, const std::vector<Value>& targets, std::span<const Value> made)
    {
        size_t next = targets.size();
        for (size_t i = 0; i < targets.size(); ++i) {
            set_primal(targets[i], made[i]);
            for (size_t d = 0; d < activity.directions(); ++d)
                if (activity(targets[i], d)) set_tangent(builder, targets[i], d, made[next++]);
        }
    }

    void copy(Builder& builder, const Instruction& made, const If& choice)
    {
        auto arm = [&](size_t which) {
            return [&, which] {
                emit(builder, choice.arms[which]);
                return with_tangents(builder, choice.arms[which].yields, 0, made.results);
            };
        };
        bind(builder, made.results, builder.if_else(primal(made.operands[0]), arm(0), arm(1)));
    }

    void copy(Builder& builder, const Instruction& made, const For& loop)
    {
        const Block& body = loop.body[0];
        const std::vector<Value> carried(body.parameters.begin() + 1, body.parameters.end());
        auto iterate = [&](Value iteration, std::span<const Value> values) {
            set_primal(body.parameters[0], iteration);
            bind(builder, carried, values);
            emit(builder, body);
            return with_tangents(builder, body.yields, 0, carried);
        };
        std::vector<Value> initial = with_tangents(builder, made.operands, 1, carried);
        bind(builder, made.results, builder.for_loop(primal(made.operands[0]), loop.trip_max, initial, iterate));
    }
};

std::string pattern_of(const Seeds& seeds)
{
    std::string pattern;
    for (const std::vector<Seed>& row : seeds) {
        if (!pattern.empty()) pattern += ',';
        for (Seed seed : row) pattern += seed == Seed::none ? '.' : seed == Seed::unit ? '1' : 't';
    }
    return pattern;
}

Seeds first_argument_seeds(const Function& function)
{
    const size_t size = function.first_argument_size;
    Seeds seeds(function.parameters.size(), std::vector<Seed>(size, Seed::none));
    for (size_t p = 0; p < size; ++p)
        if (function.type(function.parameters[p]) == Type::real) seeds[p][p] = Seed::unit;
    return seeds;
}

// HAPTEL_READS_* of what an entry reads.
uint32_t inputs_read(const Block& block)
{
    uint32_t bits = 0;
    for (const Instruction& made : block.instructions) {
        if (auto* read = std::get_if<ReadInput>(&made.kind)) {
            Input input = read->input;
            bits |= input <= Input::p_z        ? HAPTEL_READS_POINT
                    : input <= Input::n_z      ? HAPTEL_READS_NORMAL
                    : input <= Input::uv_y     ? HAPTEL_READS_UV
                    : input == Input::time     ? HAPTEL_READS_TIME
                    : input <= Input::n_dp_22  ? HAPTEL_READS_NORMAL
                    : input <= Input::uv_dp_12 ? HAPTEL_READS_UV
                    : input <= Input::center_z ? HAPTEL_READS_CENTER
                    : input <= Input::extent_z ? HAPTEL_READS_EXTENT
                                               : HAPTEL_READS_FOOTPRINT;
        }
        if (auto* choice = std::get_if<If>(&made.kind))
            for (const Block& arm : choice->arms) bits |= inputs_read(arm);
        if (auto* loop = std::get_if<For>(&made.kind)) bits |= inputs_read(loop->body[0]);
    }
    return bits;
}

} // namespace

struct Differentiator::Memo {
    std::map<std::pair<uint32_t, Seeds>, Derivative> derivatives;
    Dependences dependences;

    explicit Memo(const Module& module) : dependences(module) {}
};

Differentiator::Differentiator(Module& whole) : module(whole), memo(std::make_unique<Memo>(whole)) {}

Differentiator::~Differentiator() = default;

Derivative Differentiator::derivative(uint32_t function, const Seeds& seeds)
{
    const auto key = std::make_pair(function, seeds);
    if (auto known = memo->derivatives.find(key); known != memo->derivatives.end()) return known->second;

    const Function source = module.functions[function]; // a copy: the module grows meanwhile
    const size_t directions = seeds.empty() ? 0 : seeds[0].size();
    Activity activity(source.value_types.size(), directions);
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < directions; ++d)
            if (seeds[p][d] != Seed::none) activity.set(source.parameters[p], d);
    propagate(source, memo->dependences, nullptr, activity);

    const Emitter::FindDerivative find = [this](uint32_t callee, const Seeds& wanted) {
        return derivative(callee, wanted);
    };
    Emitter emitter(source, activity, memo->dependences, find);
    emitter.prepare(source.body);

    const bool is_jacobian = directions > 0 && seeds == first_argument_seeds(source);
    Builder builder(module, "d " + source.name + (is_jacobian ? "" : " [" + pattern_of(seeds) + "]"));
    builder.function().first_argument_size = source.first_argument_size;
    builder.function().facts = source.facts; // its first result is the original's
    for (Value parameter : source.parameters) emitter.set_primal(parameter, builder.parameter(source.type(parameter)));
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < directions; ++d)
            if (seeds[p][d] == Seed::given)
                emitter.set_tangent(builder, source.parameters[p], d, builder.parameter(Type::real));
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < directions; ++d)
            if (seeds[p][d] == Seed::unit) emitter.set_tangent(builder, source.parameters[p], d, builder.real(1));
    emitter.emit(builder, source.body);

    Derivative made;
    std::vector<Value> results;
    for (Value result : source.body.yields) results.push_back(emitter.primal(result));
    for (Value result : source.body.yields) {
        std::vector<bool>& row = made.exists.emplace_back();
        for (size_t d = 0; d < directions; ++d) {
            const Tangent& tangent = emitter.tangent(result, d);
            row.push_back(tangent.has_value());
            if (tangent) results.push_back(*tangent);
        }
    }
    made.function = builder.finish(results);
    return memo->derivatives.emplace(key, made).first->second;
}

Derivative Differentiator::jacobian(uint32_t function)
{
    return derivative(function, first_argument_seeds(module.functions[function]));
}

void Differentiator::make_entries(Texture& texture)
{
    const Function source = module.functions[texture.body];
    const Emitter::FindDerivative find = [this](uint32_t callee, const Seeds& wanted) {
        return derivative(callee, wanted);
    };
    auto make = [&](size_t directions, const std::string& name) {
        Activity activity(source.value_types.size(), directions);
        propagate(source, memo->dependences, input_is_active, activity);
        Emitter emitter(source, activity, memo->dependences, find);
        emitter.prepare(source.body);

        Builder builder(module, name);
        emitter.emit(builder, source.body);
        builder.span = source.body.instructions.empty() ? Span{} : source.body.instructions.back().span;
        const Value zero = builder.real(0), height = emitter.primal(source.body.yields[0]);
        const Value height_is_fine = builder.operation(Op::is_finite, {height});
        std::vector<Value> results{builder.operation(Op::select, {height_is_fine, height, zero})};
        Value faults = builder.operation(Op::select,
                                         {height_is_fine, builder.u32(0), builder.u32(HAPTEL_FAULT_HEIGHT_NOT_FINITE)});

        if (directions > 0) {
            std::vector<Value> gradient;
            Value gradient_is_fine = builder.boolean(true);
            for (size_t d = 0; d < directions; ++d) {
                const Tangent& tangent = emitter.tangent(source.body.yields[0], d);
                gradient.push_back(tangent ? *tangent : zero);
                Value is_fine = builder.operation(Op::is_finite, {gradient.back()});
                gradient_is_fine = builder.operation(Op::land, {gradient_is_fine, is_fine});
            }
            Value all_fine = builder.operation(Op::land, {height_is_fine, gradient_is_fine});
            for (Value component : gradient)
                results.push_back(builder.operation(Op::select, {all_fine, component, zero}));
            Value gradient_fault = builder.operation(
                Op::select, {gradient_is_fine, builder.u32(0), builder.u32(HAPTEL_FAULT_GRADIENT_NOT_FINITE)});
            // the bits are disjoint: either is an "or" through signed words
            Value both = builder.operation(
                Op::ior, {builder.operation(Op::u_as_i, {faults}), builder.operation(Op::u_as_i, {gradient_fault})});
            faults = builder.operation(Op::i_as_u, {both});
        }
        results.push_back(faults);
        return builder.finish(results);
    };
    texture.height = make(0, texture.name + " height");
    texture.height_gradient = make(axes, texture.name + " height and gradient");
    texture.reads = inputs_read(module.functions[texture.height].body) |
                    inputs_read(module.functions[texture.height_gradient].body);
}

} // namespace haptel::ir
