// Makes the instructions of one function, folding and sharing on the way.
//
// Folded are only identities that keep NaN, infinity and -0 (the list stands in builder.cpp); equal pure operations in
// an enclosing block are shared.
#pragma once

#include "lang/ir/ir.h"

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>

namespace haptel::ir {

class Builder {
public:
    Builder(Module& module, std::string name);
    ~Builder();
    Builder(const Builder&) = delete;

    Value parameter(Type type); // before the first instruction

    Value real(double value);
    Value i32(int32_t value);
    Value u32(uint32_t value);
    Value boolean(bool value);
    Value input(Input input);
    Value texture_parameter(uint32_t index, Type type);
    Value table(uint32_t table, Value index); // index in range; see clamp_index
    Value operation(Op op, std::span<const Value> operands);
    Value operation(Op op, std::initializer_list<Value> operands);
    Value point_derivative(uint32_t axis, Value of);
    std::vector<Value> call(uint32_t function, std::span<const Value> arguments);

    // Both arms run `build`, which returns the values to yield (same number and types in both).
    using Arm = std::function<std::vector<Value>()>;
    std::vector<Value> if_else(Value condition, const Arm& then_arm, const Arm& else_arm);
    // `trips` must be within [.., trip_max] by construction: the builder clamps it where it cannot see that it is.
    using Body = std::function<std::vector<Value>(Value iteration, std::span<const Value> carried)>;
    std::vector<Value> for_loop(Value trips, uint32_t trip_max, std::span<const Value> initial, const Body& body);

    // Index forced into [0, size - 1]; no code where that is plain from its making (x & c, x % c of uint, constants).
    Value clamp_index(Value index, uint32_t size);

    // If the value is a known constant.
    std::optional<double> real_constant(Value value) const;
    std::optional<uint32_t> int_constant(Value value) const;
    std::optional<bool> bool_constant(Value value) const;

    Type type(Value value) const;
    Span span; // given to every instruction made from here on

    // Ends the function with these results and adds it to the module; returns its index.
    uint32_t finish(std::span<const Value> results);
    Function& function(); // to set facts, first_argument_size before finish

private:
    struct State;
    std::unique_ptr<State> state;
};

} // namespace haptel::ir
