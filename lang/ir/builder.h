// Makes the instructions of one function, folding and sharing on the way.
//
// Folded are only identities that keep NaN, infinity and -0 (the list stands in fold.cpp); equal pure operations in an
// enclosing block are shared.
#pragma once

#include "lang/ir/ir.h"

#include <functional>
#include <initializer_list>
#include <span>
#include <unordered_map>

namespace haptel::ir {

// How a value was made, as far as folding looks.
struct Definition {
    std::optional<Op> op = {};
    Value operand[4] = {};
    bool is_constant = false;
    double real = 0;
    std::optional<IntRange> range = {}; // integers and booleans; absent: that of the type
};

class Builder {
public:
    Builder(Module& module, std::string name);
    Builder(const Builder&) = delete;

    Value parameter(Type type); // before the first instruction

    // An instruction with that one result: constants and what is read.
    Value simple(const Kind& kind, std::span<const Value> operands, Type type);
    Value real(double value) { return simple(RealConstant{value}, {}, Type::real); }
    Value word(uint32_t bits, Type type) { return simple(WordConstant{bits}, {}, type); } // i32, u32, boolean
    Value i32(int32_t value) { return word(static_cast<uint32_t>(value), Type::i32); }
    Value u32(uint32_t value) { return word(value, Type::u32); }
    Value boolean(bool value) { return word(value, Type::boolean); }
    Value input(Input input) { return simple(ReadInput{input}, {}, Type::real); }
    Value texture_parameter(uint32_t index, Type type) { return simple(ReadParameter{index}, {}, type); }
    Value table(uint32_t table, Value index) // index in range; see clamp_index
    {
        return simple(ReadTable{table}, {&index, 1}, module.tables[table].element);
    }
    Value operation(Op op, std::span<const Value> operands);
    Value operation(Op op, std::initializer_list<Value> operands)
    {
        return operation(op, std::span<const Value>(operands.begin(), operands.size()));
    }
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
    std::optional<uint32_t> word_constant(Value value) const; // i32, u32, boolean

    Type type(Value value) const { return target.type(value); }
    Span span = {}; // given to every instruction made from here on

    // Ends the function with these results and adds it to the module; returns its index.
    uint32_t finish(std::span<const Value> results);
    Function& function() { return target; } // to set facts, first_argument_size before finish

private:
    // What an instruction without effects is made of: equal keys, equal results.
    struct Key {
        size_t kind; // Kind::index()
        Type type;
        uint64_t payload;        // of the kind
        std::u32string operands; // by Value::index; few of them need no memory
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        size_t operator()(const Key& key) const;
    };
    struct Scope {
        Block block = {};
        std::vector<const Key*> keys = {}; // known only while the scope is open
    };
    class Fold;

    Module& module;
    Function target;
    std::vector<Definition> definitions; // by Value::index
    std::vector<Scope> scopes;
    std::unordered_map<Key, Value, KeyHash> known; // first result

    static Key key_of(const Kind& kind, Type type, std::span<const Value> operands);
    const Definition& definition(Value value) const { return definitions[value.index]; }
    IntRange range(Value value) const { return *definition(value).range; }
    Value new_value(Type type, Definition definition = {});
    // First result of an equal instruction in an open block, or of this one, appended. Results are consecutive.
    Value emit(const Key& key, const Kind& kind, std::span<const Value> operands, std::span<const Type> types,
               const Definition& definition);
    Block closed(const Arm& arm); // what the arm makes, and yields
    // A value that equals op(operands) bit for bit (any NaN equals any NaN) and costs less, if the list in fold.cpp has
    // one.
    std::optional<Value> fold(Op op, std::span<const Value> operands);
};

} // namespace haptel::ir
