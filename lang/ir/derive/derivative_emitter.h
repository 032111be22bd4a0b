// Copies a function into a builder, value by value, with the tangents beside.
#pragma once

#include "lang/ir/builder.h"
#include "lang/ir/derive/derivative_rules.h"
#include "lang/ir/derive/differentiate.h"

namespace haptel::ir {

// Does an input of the point move with p along the axis? n and uv do, by their Jacobians on the facet.
bool input_is_active(Input input, size_t axis);

class DerivativeEmitter {
public:
    DerivativeEmitter(Module& module, std::string name, const Function& source, const Activity& activity,
                      Differentiator& of_callees, PointDerivatives point_derivatives);

    // Gives the function in the builder what it has of the source, and parameters: those of the source, then its given
    // tangents.
    void begin(const Seeds& seeds);
    void emit(const Block& block);
    // The function's results, then their tangents, if they are wanted; which of them exist goes to `exists`.
    std::vector<Value> results(bool tangents_wanted, std::vector<std::vector<bool>>& exists) const;

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
    void set_tangent(Value value, size_t direction, Tangent made);
    std::vector<Value> primals_of(std::span<const Value> values) const;
    Value made_tangent(Value value, size_t direction); // 0 where there is none
    // The values, then the tangents of those that `like` has by activity; and back.
    std::vector<Value> with_tangents(std::span<const Value> values, std::span<const Value> like);
    void bind(std::span<const Value> targets, std::span<const Value> made);
    Tangent chain(const std::vector<Tangent>& row, const Instruction& made, const std::vector<size_t>& columns,
                  size_t direction);

    template <typename Simple>
    void copy(const Instruction& made, const Simple& kind) // constants, and what is read but moves with no point
    {
        const Value result = made.results[0];
        set_primal(result, builder.simple(kind, primals_of(made.operands), function.type(result)));
    }
    void copy(const Instruction& made, const Operation& operation);
    void copy(const Instruction& made, const ReadInput& read);
    void copy(const Instruction& made, const Call& call);
    void copy(const Instruction& made, const PointDerivative& derivative);
    void copy(const Instruction& made, const If& choice);
    void copy(const Instruction& made, const For& loop);
};

} // namespace haptel::ir
