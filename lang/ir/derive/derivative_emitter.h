// Copies a function into a builder, value by value, with the tangents beside.
#pragma once

#include "lang/ir/builder.h"
#include "lang/ir/derive/activity.h"
#include "lang/ir/derive/derivative_rules.h"
#include "lang/ir/derive/differentiate.h"

namespace haptel::ir {

constexpr size_t axes = 3; // directions of an entry's gradient: p_x, p_y, p_z

// Does an input of the point move with p along the axis? n and uv do, by their Jacobians on the facet.
bool input_is_active(Input input, size_t axis);

// How the derivative of a callee is had at a call.
struct CallPlan {
    enum class How : uint8_t {
        plain,    // not at all: no result has a tangent
        jacobian, // by its derivative with respect to the `columns`, and the chain rule at the call
        tangents, // by passing the tangents on
    } how = How::plain;
    std::vector<size_t> columns; // active arguments that a result depends on
    Seeds seeds;
    bool tangents_of_results = true; // false: the callee is asked for its values alone
};

// The way that needs fewer directions inside the callee. The chain rule at the call is no way for a callee that asks
// for derivatives with respect to the point: there it matters how the tangents themselves move.
CallPlan plan_call(const Instruction& call, const Dependence& depends, const Activity& activity, bool callee_asks);

// What an emitter asks about the functions that are called.
class Callees {
public:
    virtual CallPlan plan(const Instruction& call, const Activity& activity) = 0;
    virtual Derivative derivative(uint32_t callee, const CallPlan& plan) = 0;
    // Whether derivatives with respect to the point become the values they stand for: the directions are those of p.
    virtual bool resolves_point_derivatives() const = 0;

protected:
    ~Callees() = default;
};

class DerivativeEmitter {
public:
    DerivativeEmitter(const Function& source, const Activity& activity, Callees& callees);

    // Asks for the derivative of every callee, so that none has to be made while this function is.
    void prepare(const Block& block);
    // Gives the function in the builder what it has of the source, and parameters: those of the source, then its given
    // tangents.
    void begin(Builder& builder, const Seeds& seeds);
    void emit(Builder& builder, const Block& block);
    // The function's results, then their tangents, if they are wanted; which of them exist goes to `exists`.
    std::vector<Value> results(bool tangents_wanted, std::vector<std::vector<bool>>& exists) const;

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
    Callees& callees;
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
    void copy(Builder& builder, const Instruction& made, const WordConstant& constant);
    void copy(Builder& builder, const Instruction& made, const ReadInput& read);
    void copy(Builder& builder, const Instruction& made, const ReadParameter& read);
    void copy(Builder& builder, const Instruction& made, const ReadTable& read);
    void copy(Builder& builder, const Instruction& made, const Call& call);
    void copy(Builder& builder, const Instruction& made, const PointDerivative& derivative);
    void copy(Builder& builder, const Instruction& made, const If& choice);
    void copy(Builder& builder, const Instruction& made, const For& loop);
};

} // namespace haptel::ir
