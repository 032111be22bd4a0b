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
    Value operand[4] = {};
    double real = 0;
    IntRange range{0, 0}; // integers and booleans
};

// Kind, payload and operands of an instruction without effects: equal keys, equal results. A longer list of operands is
// interned beforehand, link by link, and stands for one.
struct InstructionKey {
    uint32_t kind = 0;
    uint64_t payload = 0;
    uint32_t operand[4] = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
    bool operator==(const InstructionKey&) const = default;
};
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
    std::unordered_map<InstructionKey, uint32_t, InstructionKeyHash> known; // first result, or number of a list
    uint32_t lists = 0;

    Value new_value(Type type); // nothing known of it: an integer may have any value
    Value new_value(Type type, const Definition& definition);
    // First result of an equal instruction in an open block, or of this one, appended. Results are consecutive.
    Value emit(const InstructionKey& key, Instruction instruction, std::span<const Type> types,
               const Definition* definition = nullptr);
    // The same of an instruction with one result.
    Value single(const InstructionKey& key, Kind kind, std::span<const Value> operands, Span span, Type type,
                 const Definition* definition = nullptr);
    uint32_t list(std::span<const Value> values); // equal lists, equal numbers
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
