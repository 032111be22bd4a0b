#include "lang/ir/derive/derivative_emitter.h"

#include <algorithm>

namespace haptel::ir {
namespace {

// dn/dp and duv/dp on the facet are inputs of their own.
Input input_derivative(Input input, size_t axis)
{
    auto row = [&](Input first, Input of) {
        size_t i = static_cast<size_t>(input) - static_cast<size_t>(of);
        return static_cast<Input>(static_cast<size_t>(first) + axes * i + axis);
    };
    return input <= Input::n_z ? row(Input::n_dp_00, Input::n_x) : row(Input::uv_dp_00, Input::uv_x);
}

} // namespace

bool input_is_active(Input input, size_t axis)
{
    if (input <= Input::p_z) return static_cast<size_t>(input) == axis;
    return input <= Input::uv_y;
}

CallPlan plan_call(const Instruction& call, const Dependence& depends, const Activity& activity, bool callee_asks)
{
    CallPlan plan;
    auto is_active = [&](Value result) { return activity.any(result); };
    if (std::none_of(call.results.begin(), call.results.end(), is_active)) return plan;
    for (size_t p = 0; p < call.operands.size(); ++p) {
        auto reads_it = [&](const std::vector<bool>& row) { return static_cast<bool>(row[p]); };
        if (activity.any(call.operands[p]) && std::any_of(depends.begin(), depends.end(), reads_it))
            plan.columns.push_back(p);
    }
    if (plan.columns.empty()) return plan;
    const bool by_jacobian = plan.columns.size() <= activity.directions() && !callee_asks;
    plan.how = by_jacobian ? CallPlan::How::jacobian : CallPlan::How::tangents;
    const size_t directions = by_jacobian ? plan.columns.size() : activity.directions();
    plan.seeds.assign(call.operands.size(), std::vector<Seed>(directions, Seed::none));
    for (size_t column = 0; column < plan.columns.size(); ++column) {
        size_t p = plan.columns[column];
        if (by_jacobian) {
            plan.seeds[p][column] = Seed::unit;
            continue;
        }
        for (size_t d = 0; d < directions; ++d)
            if (activity(call.operands[p], d)) plan.seeds[p][d] = Seed::given;
    }
    return plan;
}

DerivativeEmitter::DerivativeEmitter(const Function& source, const Activity& active, Callees& called)
    : function(source)
    , activity(active)
    , callees(called)
    , primals(source.value_types.size())
    , tangents(source.value_types.size() * active.directions())
{
}

void DerivativeEmitter::prepare(const Block& block)
{
    std::vector<std::pair<uint32_t, CallPlan>> wanted;
    for_each_instruction(block, [&](const Instruction& made) {
        const auto* call = std::get_if<Call>(&made.kind);
        if (!call) return;
        CallPlan plan = callees.plan(made, activity);
        if (plan.how != CallPlan::How::plain) wanted.emplace_back(call->function, std::move(plan));
    });
    for (const auto& [callee, plan] : wanted) callees.derivative(callee, plan);
}

void DerivativeEmitter::begin(Builder& builder, const Seeds& seeds)
{
    Function& made = builder.function();
    made.first_argument_size = function.first_argument_size;
    made.is_library = function.is_library;
    made.facts = function.facts; // its first results are the original's
    for (Value parameter : function.parameters) set_primal(parameter, builder.parameter(function.type(parameter)));
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < activity.directions(); ++d)
            if (seeds[p][d] == Seed::given)
                set_tangent(builder, function.parameters[p], d, builder.parameter(Type::real));
}

std::vector<Value> DerivativeEmitter::results(bool tangents_wanted, std::vector<std::vector<bool>>& exists) const
{
    std::vector<Value> all = primals_of(function.body.yields);
    for (Value result : function.body.yields) {
        std::vector<bool>& row = exists.emplace_back(activity.directions(), false);
        for (size_t d = 0; tangents_wanted && d < activity.directions(); ++d) {
            row[d] = tangent(result, d).has_value();
            if (row[d]) all.push_back(*tangent(result, d));
        }
    }
    return all;
}

void DerivativeEmitter::emit(Builder& builder, const Block& block)
{
    for (const Instruction& made : block.instructions) {
        builder.span = made.span;
        std::visit([&](const auto& kind) { copy(builder, made, kind); }, made.kind);
    }
}

void DerivativeEmitter::set_tangent(Builder& builder, Value value, size_t direction, Tangent made)
{
    if (made && builder.real_constant(*made) == 0.0) made.reset(); // a known zero is no tangent
    tangents[value.index * activity.directions() + direction] = made;
}

std::vector<Value> DerivativeEmitter::primals_of(const std::vector<Value>& values, size_t first) const
{
    std::vector<Value> mapped;
    for (size_t i = first; i < values.size(); ++i) mapped.push_back(primal(values[i]));
    return mapped;
}

Value DerivativeEmitter::made_tangent(Builder& builder, Value value, size_t direction) const
{
    const Tangent& known = tangent(value, direction);
    return known ? *known : builder.real(0);
}

std::vector<Value> DerivativeEmitter::with_tangents(Builder& builder, const std::vector<Value>& values, size_t first,
                                                    const std::vector<Value>& like) const
{
    std::vector<Value> all = primals_of(values, first);
    for (size_t i = 0; i < like.size(); ++i)
        for (size_t d = 0; d < activity.directions(); ++d)
            if (activity(like[i], d)) all.push_back(made_tangent(builder, values[first + i], d));
    return all;
}

void DerivativeEmitter::bind(Builder& builder, const std::vector<Value>& targets, std::span<const Value> made)
{
    size_t next = targets.size();
    for (size_t i = 0; i < targets.size(); ++i) {
        set_primal(targets[i], made[i]);
        for (size_t d = 0; d < activity.directions(); ++d)
            if (activity(targets[i], d)) set_tangent(builder, targets[i], d, made[next++]);
    }
}

Tangent DerivativeEmitter::chain(Builder& builder, const std::vector<Tangent>& row, const Instruction& made,
                                 const std::vector<size_t>& columns, size_t direction) const
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

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const Operation& operation)
{
    const Value result = made.results[0];
    std::vector<Value> operands = primals_of(made.operands);
    set_primal(result, builder.operation(operation.op, operands));
    if (function.type(result) != Type::real) return;
    std::vector<Tangent> of_operands(made.operands.size());
    for (size_t d = 0; d < activity.directions(); ++d) {
        if (!activity(result, d)) continue;
        for (size_t i = 0; i < made.operands.size(); ++i) of_operands[i] = tangent(made.operands[i], d);
        set_tangent(builder, result, d, differentiate(builder, operation.op, operands, primal(result), of_operands));
    }
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const RealConstant& constant)
{
    set_primal(made.results[0], builder.real(constant.value));
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const WordConstant& constant)
{
    set_primal(made.results[0], builder.word(constant.bits, function.type(made.results[0])));
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const ReadInput& read)
{
    const Value result = made.results[0];
    set_primal(result, builder.input(read.input));
    for (size_t d = 0; d < activity.directions(); ++d) {
        if (!activity(result, d)) continue;
        set_tangent(builder, result, d,
                    read.input <= Input::p_z ? builder.real(1) : builder.input(input_derivative(read.input, d)));
    }
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const ReadParameter& read)
{
    set_primal(made.results[0], builder.texture_parameter(read.parameter, function.type(made.results[0])));
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const ReadTable& read)
{
    set_primal(made.results[0], builder.table(read.table, primal(made.operands[0])));
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const Call& call)
{
    CallPlan plan = callees.plan(made, activity);
    std::vector<Value> arguments = primals_of(made.operands);
    if (plan.how == CallPlan::How::plain) {
        std::vector<Value> results = builder.call(call.function, arguments);
        for (size_t r = 0; r < made.results.size(); ++r) set_primal(made.results[r], results[r]);
        return;
    }
    Derivative derivative = callees.derivative(call.function, plan);
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
                        plan.how == CallPlan::How::jacobian ? chain(builder, row, made, plan.columns, d) : row[d]);
    }
}

// Derivatives in two directions may be taken in either order.
void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const PointDerivative& derivative)
{
    const Value result = made.results[0], of = made.operands[0];
    if (callees.resolves_point_derivatives()) return set_primal(result, made_tangent(builder, of, derivative.axis));
    set_primal(result, builder.point_derivative(derivative.axis, primal(of)));
    for (size_t d = 0; d < activity.directions(); ++d)
        if (const Tangent& inner = tangent(of, d); activity(result, d) && inner)
            set_tangent(builder, result, d, builder.point_derivative(derivative.axis, *inner));
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const If& choice)
{
    auto arm = [&](size_t which) {
        return [&, which] {
            emit(builder, choice.arms[which]);
            return with_tangents(builder, choice.arms[which].yields, 0, made.results);
        };
    };
    bind(builder, made.results, builder.if_else(primal(made.operands[0]), arm(0), arm(1)));
}

void DerivativeEmitter::copy(Builder& builder, const Instruction& made, const For& loop)
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

} // namespace haptel::ir
