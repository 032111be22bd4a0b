// Copies a function into a builder, value by value, with the tangents beside. Body of the differentiator: included by
// its source file and by nobody else.
#pragma once

#include "lang/ir/builder.h"
#include "lang/ir/derive/derivative_rules.h"
#include "lang/ir/derive/differentiate.h"

namespace haptel::ir {

// dn/dp and duv/dp on the facet are inputs of their own.
inline Input input_derivative(Input input, size_t axis)
{
    auto row = [&](Input first, Input of) {
        size_t i = static_cast<size_t>(input) - static_cast<size_t>(of);
        return static_cast<Input>(static_cast<size_t>(first) + axes * i + axis);
    };
    return input <= Input::n_z ? row(Input::n_dp_00, Input::n_x) : row(Input::uv_dp_00, Input::uv_x);
}

// Does an input of the point move with p along the axis? n and uv do, by their Jacobians on the facet.
inline bool input_is_active(Input input, size_t axis)
{
    if (input <= Input::p_z) return static_cast<size_t>(input) == axis;
    return input <= Input::uv_y;
}

class DerivativeEmitter {
public:
    DerivativeEmitter(Module& module, std::string name, const Function& source, const Activity& active,
                      Differentiator& of_callees, PointDerivatives what)
        : builder(module, std::move(name))
        , function(source)
        , activity(active)
        , callees(of_callees)
        , point_derivatives(what)
        , primals(source.value_types.size())
        , tangents(source.value_types.size() * active.directions())
    {
    }

    // Gives the function in the builder what it has of the source, and parameters: those of the source, then its given
    // tangents.
    void begin(const Seeds& seeds)
    {
        Function& made = builder.function();
        made.first_argument_size = function.first_argument_size;
        made.is_library = function.is_library;
        made.facts = function.facts; // its first results are the original's
        for (Value parameter : function.parameters) set_primal(parameter, builder.parameter(function.type(parameter)));
        for (const Seed kind : {Seed::given, Seed::unit}) // parameters stand before the first instruction
            for (size_t p = 0; p < seeds.size(); ++p)
                for (size_t d = 0; d < activity.directions(); ++d)
                    if (seeds[p][d] == kind)
                        set_tangent(function.parameters[p], d,
                                    kind == Seed::given ? builder.parameter(Type::real) : builder.real(1));
    }

    void emit(const Block& block)
    {
        for (const Instruction& made : block.instructions) {
            builder.span = made.span;
            std::visit([&](const auto& kind) { copy(made, kind); }, made.kind);
        }
    }

    // The function's results, then their tangents, if they are wanted; which of them exist goes to `exists`.
    std::vector<Value> results(bool tangents_wanted, std::vector<std::vector<bool>>& exists) const
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

    Value primal(Value value) const { return primals[value.index]; }
    const Tangent& tangent(Value value, size_t direction) const
    {
        return tangents[value.index * activity.directions() + direction];
    }

    Builder builder;

private:
    const Function& function;
    const Activity& activity;
    Differentiator& callees;
    const PointDerivatives point_derivatives;
    std::vector<Value> primals;    // by Value::index of the source
    std::vector<Tangent> tangents; // likewise, by direction

    void set_primal(Value value, Value made) { primals[value.index] = made; }
    void set_tangent(Value value, size_t direction, Tangent made)
    {
        if (made && builder.real_constant(*made) == 0.0) made.reset(); // a known zero is no tangent
        tangents[value.index * activity.directions() + direction] = made;
    }

    std::vector<Value> primals_of(std::span<const Value> values) const
    {
        std::vector<Value> mapped;
        for (Value value : values) mapped.push_back(primal(value));
        return mapped;
    }

    // 0 where there is none.
    Value made_tangent(Value value, size_t direction)
    {
        const Tangent& known = tangent(value, direction);
        return known ? *known : builder.real(0);
    }

    // The values, then the tangents of those that `like` has by activity; and back.
    std::vector<Value> with_tangents(std::span<const Value> values, std::span<const Value> like)
    {
        std::vector<Value> all = primals_of(values);
        for (size_t i = 0; i < like.size(); ++i)
            for (size_t d = 0; d < activity.directions(); ++d)
                if (activity(like[i], d)) all.push_back(made_tangent(values[i], d));
        return all;
    }

    void bind(std::span<const Value> targets, std::span<const Value> made)
    {
        size_t next = targets.size();
        for (size_t i = 0; i < targets.size(); ++i) {
            set_primal(targets[i], made[i]);
            for (size_t d = 0; d < activity.directions(); ++d)
                if (activity(targets[i], d)) set_tangent(targets[i], d, made[next++]);
        }
    }

    Tangent chain(const std::vector<Tangent>& row, const Instruction& made, const std::vector<size_t>& columns,
                  size_t direction)
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

    template <typename Simple>
    void copy(const Instruction& made, const Simple& kind) // constants, and what is read but moves with nothing
    {
        const Value result = made.results[0];
        set_primal(result, builder.simple(kind, primals_of(made.operands), function.type(result)));
    }

    void copy(const Instruction& made, const Operation& operation)
    {
        const Value result = made.results[0];
        std::vector<Value> operands = primals_of(made.operands);
        set_primal(result, builder.operation(operation.op, operands));
        if (function.type(result) != Type::real) return;
        std::vector<Tangent> of_operands(made.operands.size());
        for (size_t d = 0; d < activity.directions(); ++d) {
            if (!activity(result, d)) continue;
            for (size_t i = 0; i < made.operands.size(); ++i) of_operands[i] = tangent(made.operands[i], d);
            set_tangent(result, d, differentiate(builder, operation.op, operands, primal(result), of_operands));
        }
    }

    void copy(const Instruction& made, const ReadInput& read)
    {
        const Value result = made.results[0];
        set_primal(result, builder.input(read.input));
        for (size_t d = 0; d < activity.directions(); ++d)
            if (activity(result, d))
                set_tangent(result, d,
                            read.input <= Input::p_z ? builder.real(1)
                                                     : builder.input(input_derivative(read.input, d)));
    }

    void copy(const Instruction& made, const ReadParameter& read)
    {
        const Value result = made.results[0];
        set_primal(result, builder.simple(read, {}, function.type(result)));
        for (size_t d = 0; d < activity.directions(); ++d)
            if (activity(result, d)) set_tangent(result, d, builder.real(1));
    }

    void copy(const Instruction& made, const Call& call)
    {
        const std::optional<CallPlan> plan = callees.plan(made, activity, point_derivatives);
        std::vector<Value> arguments = primals_of(made.operands);
        if (!plan) {
            const std::vector<Value> results = builder.call(call.function, arguments);
            for (size_t r = 0; r < made.results.size(); ++r) set_primal(made.results[r], results[r]);
            return;
        }
        const Derivative derivative = callees.derivative(plan->request);
        const Seeds& seeds = plan->request.seeds;
        for (size_t p = 0; p < seeds.size(); ++p)
            for (size_t d = 0; d < seeds[p].size(); ++d)
                if (seeds[p][d] == Seed::given) arguments.push_back(made_tangent(made.operands[p], d));
        const std::vector<Value> results = builder.call(derivative.function, arguments);
        size_t next = made.results.size();
        for (size_t r = 0; r < made.results.size(); ++r) {
            set_primal(made.results[r], results[r]);
            std::vector<Tangent> row; // by direction of the callee
            for (bool exists : derivative.exists[r]) row.push_back(exists ? Tangent(results[next++]) : Tangent());
            for (size_t d = 0; d < activity.directions(); ++d)
                set_tangent(made.results[r], d, plan->by_jacobian ? chain(row, made, plan->columns, d) : row[d]);
        }
    }

    // Derivatives in two directions may be taken in either order.
    void copy(const Instruction& made, const PointDerivative& derivative)
    {
        const Value result = made.results[0], of = made.operands[0];
        if (point_derivatives == PointDerivatives::resolved)
            return set_primal(result, made_tangent(of, derivative.axis));
        set_primal(result, builder.point_derivative(derivative.axis, primal(of)));
        for (size_t d = 0; d < activity.directions(); ++d)
            if (const Tangent& inner = tangent(of, d); activity(result, d) && inner)
                set_tangent(result, d, builder.point_derivative(derivative.axis, *inner));
    }

    void copy(const Instruction& made, const If& choice)
    {
        auto arm = [&](size_t which) {
            return [&, which] {
                emit(choice.arms[which]);
                return with_tangents(choice.arms[which].yields, made.results);
            };
        };
        bind(made.results, builder.if_else(primal(made.operands[0]), arm(0), arm(1)));
    }

    void copy(const Instruction& made, const For& loop)
    {
        const Block& body = loop.body[0];
        const auto carried = std::span(body.parameters).subspan(1);
        auto iterate = [&](Value iteration, std::span<const Value> values) {
            set_primal(body.parameters[0], iteration);
            bind(carried, values);
            emit(body);
            return with_tangents(body.yields, carried);
        };
        const std::vector<Value> initial = with_tangents(std::span(made.operands).subspan(1), carried);
        bind(made.results, builder.for_loop(primal(made.operands[0]), loop.trip_max, initial, iterate));
    }
};

} // namespace haptel::ir
