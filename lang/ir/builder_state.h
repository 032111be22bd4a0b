// What a Builder knows while a function grows. Shared by the builder's two source files and by nobody else.
#pragma once

#include "lang/ir/builder.h"
#include "lang/ir/int_range.h"

#include <unordered_map>

namespace haptel::ir {

// How a value was made, as far as folding looks.
struct Definition {
    enum class Kind : uint8_t { other, operation, real, integer, boolean } kind = Kind::other;
    Op op{};
    Value operand[4];
    double real = 0;
    IntRange range{0, 0}; // integers and booleans
};

// Kind, payload and operands of an instruction without effects: equal keys, equal results.
using InstructionKey = std::vector<uint32_t>;
struct InstructionKeyHash {
    size_t operator()(const InstructionKey& key) const;
};

struct Scope {
    Block block;
    std::vector<const InstructionKey*> keys; // known only while the scope is open
};

struct Builder::State {
    Module& module;
    Function function;
    std::vector<Definition> definitions; // by Value::index
    std::vector<Scope> scopes;
    std::unordered_map<InstructionKey, std::vector<Value>, InstructionKeyHash> known;

    Value new_value(Type type); // nothing known of it: an integer may have any value
    Value new_value(Type type, const Definition& definition);
    // The results of an equal instruction in an open block, or of this one, appended.
    std::vector<Value> emit(InstructionKey key, Instruction instruction, std::span<const Type> types,
                            const Definition* definition = nullptr);
    void append(Instruction instruction);
    void open();
    Block close();

    const Definition& definition(Value value) const { return definitions[value.index]; }
    bool is_operation(Value value, Op op) const;
    bool is_constant(Value value) const;
    // A value that equals op(operands) bit for bit (any NaN equals any NaN) and costs less, if the list in fold.cpp has
    // one.
    std::optional<Value> fold(Builder& builder, Op op, std::span<const Value> operands) const;
    class Fold;
};

} // namespace haptel::ir
