// One IR function as the body of an LLVM function, for one point or for many lanes: points side by side in a register.
//
// In lanes, what varies between points is a vector with an element for each, and the rest stays a scalar. A branch on
// what varies runs both arms and selects; a loop whose count varies runs to the largest, and a lane that is through
// keeps what it has. Operations are total and pure, so each lane has the bits of the form for one point.
//
// An operation with an f64 operand that varies computes in f64 and rounds its result to what it is held in.
#pragma once

#include "jit/codegen/codegen_module.h"

#include <map>
#include <set>
#include <vector>

namespace haptel::jit {

using Values = llvm::SmallVector<llvm::Value*, 4>;

// for (number = 0; number < count; number += step) values = body(number, values), `initial` at first. Returns the last.
Values repeat(llvm::IRBuilder<>& builder, llvm::Value* count, uint32_t step, const Values& initial,
              llvm::function_ref<Values(llvm::Value* number, const Values& values)> body);

// What an entry reads from; null in other functions.
struct EntryArguments {
    llvm::Value* points = nullptr; // haptel_point; in lanes, haptel_points
    llvm::Value* block = nullptr;
    const ir::Texture* texture = nullptr;
    llvm::Value* first = nullptr;    // in lanes: which point is in the first of them,
    llvm::Value* is_there = nullptr; // and in which there is one at all
};

class FunctionEmitter {
public:
    // Writes where the builder stands.
    FunctionEmitter(ModuleEmitter& owner, llvm::IRBuilder<>& to, const ValueForms& value_forms,
                    const EntryArguments& entry = {});

    void define(ir::Value value, llvm::Value* made) { values[value.index] = made; }
    // The function's results in those forms.
    Values body(const std::vector<Form>& results) { return block(source.body, results); }

private:
    ModuleEmitter& module;
    const ir::Function& source;
    ValueForms forms; // those in force: a split loop takes values out of lanes
    const EntryArguments arguments;
    llvm::IRBuilder<>& builder;
    std::vector<llvm::Value*> values;             // by ir::Value::index
    std::vector<const ir::Instruction*> products; // likewise: what multiplied them
    std::set<const ir::Instruction*> done;        // ahead of their blocks

    llvm::Value* value(ir::Value used); // poison if no result needs it
    llvm::Value* value(ir::Value used, Form wanted);
    bool is_needed(const ir::Instruction& made) const;
    llvm::Value* rounded(llvm::Value* real, bool to_single);
    bool computes_in_singles(const ir::Instruction& made) const;
    llvm::Value* fused(const ir::Instruction& made, ir::Op op, bool in_singles);
    llvm::Type* type(ir::Value of) { return module.type(source.type(of), forms[of]); }

    Values block(const ir::Block& from, const std::vector<Form>& yields);
    void emit_rest(const ir::Block& from); // what is not done yet
    void emit_ahead(const std::vector<const ir::Instruction*>& instructions);
    void emit(const ir::Instruction& made);

    // The results.
    Values emit(const ir::Instruction& made, const ir::Operation& operation);
    Values emit(const ir::Instruction&, const ir::RealConstant& constant)
    {
        return {llvm::ConstantFP::get(builder.getDoubleTy(), constant.value)};
    }
    Values emit(const ir::Instruction& made, const ir::WordConstant& constant)
    {
        const bool is_truth = source.type(made.results[0]) == ir::Type::boolean;
        return {is_truth ? builder.getInt1(constant.bits != 0) : builder.getInt32(constant.bits)};
    }
    Values emit(const ir::Instruction&, const ir::PointDerivative&) { return {}; } // in no program that is verified
    Values emit(const ir::Instruction& made, const ir::ReadInput& read);
    Values emit(const ir::Instruction& made, const ir::ReadParameter& read);
    Values emit(const ir::Instruction& made, const ir::ReadTable& read);
    Values emit(const ir::Instruction& made, const ir::Call& call);
    Values emit(const ir::Instruction& made, const ir::If& choice);
    Values emit(const ir::Instruction& made, const ir::For& loop);

    Values emit_in_lanes(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop);
    Values emit_in_order(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop);
    Values emit_one_by_one(const ir::Block& body, const LaneLoop& loop, llvm::Value* count, Values carried);
    using Rooms = std::map<uint32_t, llvm::AllocaInst*>; // by value: where its lanes lie in memory
    void take_out_of_lanes(const ir::Block& block, Rooms& rooms);
    void take_out_of_lanes(ir::Value used, Rooms& rooms);
    llvm::AllocaInst* room_for(llvm::Type* element, uint32_t count);
};

} // namespace haptel::jit
