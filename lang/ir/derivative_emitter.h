// Copies a function into a builder, value by value, with the tangents beside.
#pragma once

#include "lang/ir/activity.h"
#include "lang/ir/builder.h"
#include "lang/ir/derivative_rules.h"
#include "lang/ir/differentiate.h"

#include <functional>

namespace haptel::ir {

constexpr size_t axes = 3; // directions of an entry's gradient: p_x, p_y, p_z

// Does an input of the point move with p along the axis? n and uv do, by their Jacobians on the facet.
bool input_is_active(Input input, size_t axis);

class DerivativeEmitter {
public:
    using FindDerivative = std::function<Derivative(uint32_t function, const Seeds&)>;

    DerivativeEmitter(const Function& source, const Activity& activity, Dependences& dependences,
                      const FindDerivative& find_derivative);

    // Asks for the derivative of every callee, so that none has to be made while this function is.
    void prepare(const Block& block);
    void emit(Builder& builder, const Block& block);

    void set_primal(Value value, Value made) { primals[value.index] = made; }
    void set_tangent(Builder& builder, Value value, size_t direction, Tangent made);
    Value primal(Value value) const { return primals[value.index]; }
    const Tangent& tangent(Value value, size_t direction) const
    {
        return tangents[value.index * activity.directions() + direction];
    }

private:
    const Function& function;
    const Activity& activity;
    Dependences& callees;
    const FindDerivative& find_derivative;
    std::vector<Value> primals;    // by Value::index of the source
    std::vector<Tangent> tangents; // likewise, by direction

    std::vector<Value> primals_of(const std::vector<Value>& values, size_t first = 0) const;
    Value made_tangent(Builder& builder, Value value, size_t direction) const; // 0 where there is none
    // The values from `first` on, then the tangents of those that `like` has by activity; and back.
    std::vector<Value> with_tangents(Builder& builder, const std::vector<Value>& values, size_t first,
                                     const std::vector<Value>& like) const;
    void bind(Builder& builder, const std::vector<Value>& targets, std::span<const Value> made);
    Tangent chain(Builder& builder, const std::vector<Tangent>& row, const Instruction& made,
                  const std::vector<size_t>& columns, size_t direction) const;

    void copy(Builder& builder, const Instruction& made, const Operation& operation);
    void copy(Builder& builder, const Instruction& made, const RealConstant& constant);
    void copy(Builder& builder, const Instruction& made, const IntConstant& constant);
    void copy(Builder& builder, const Instruction& made, const BoolConstant& constant);
    void copy(Builder& builder, const Instruction& made, const ReadInput& read);
    void copy(Builder& builder, const Instruction& made, const ReadParameter& read);
    void copy(Builder& builder, const Instruction& made, const ReadTable& read);
    void copy(Builder& builder, const Instruction& made, const Call& call);
    void copy(Builder& builder, const Instruction& made, const If& choice);
    void copy(Builder& builder, const Instruction& made, const For& loop);
};

} // namespace haptel::ir
