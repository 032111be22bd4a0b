// One IR function as the body of an LLVM function, for one point or for many lanes: points side by side in a register.
//
// In lanes, what varies between points is a vector with an element for each, and the rest stays a scalar. A branch on
// what varies runs both arms and selects; a loop whose count varies runs to the largest, and a lane that is through
// keeps what it has. Operations are total and pure, so each lane has the bits of the form for one point.
//
// An operation with an f64 operand that varies computes in f64 and rounds its result to what it is held in.
#pragma once

#include "jit/codegen/codegen_module.h"

#include <functional>
#include <map>
#include <set>
#include <vector>

namespace haptel::jit {

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
    // Writes to the end of `to`'s last block.
    FunctionEmitter(ModuleEmitter& owner, const ir::Function& from, llvm::Function& to, const ValueForms& value_forms,
                    const EntryArguments& entry = {});

    void define(ir::Value value, llvm::Value* made) { values[value.index] = made; }
    // The function's results in those forms.
    std::vector<llvm::Value*> body(const std::vector<Form>& results) { return block(source.body, results); }
    llvm::IRBuilder<>& at_end() { return builder; }

private:
    ModuleEmitter& module;
    const ir::Function& source;
    llvm::Function& target;
    ValueForms forms; // those in force: a split loop takes values out of lanes
    const EntryArguments arguments;
    llvm::IRBuilder<> builder;
    std::vector<llvm::Value*> values;             // by ir::Value::index
    std::vector<const ir::Instruction*> products; // likewise: what multiplied them
    std::set<const ir::Instruction*> done;        // ahead of their blocks

    llvm::Value* value(ir::Value used); // poison if no result needs it
    bool is_needed(const ir::Instruction& made) const;
    llvm::Value* value(ir::Value used, Form wanted);
    llvm::Value* rounded(llvm::Value* real, bool to_single);
    bool computes_in_singles(const ir::Instruction& made) const;
    const ir::Instruction* product_to_fuse(ir::Value operand, bool in_singles) const;
    bool fuse(const ir::Instruction& made, ir::Op op, bool in_singles);
    llvm::Type* type(ir::Value of) { return module.type(source.type(of), forms[of]); }
    llvm::BasicBlock* new_block(const char* name);
    llvm::Value* at_offset(llvm::Value* base, size_t offset);

    std::vector<llvm::Value*> block(const ir::Block& from, const std::vector<Form>& yields);
    void emit(const ir::Instruction& made);
    void emit(const ir::Instruction& made, const ir::Operation& operation);
    void emit(const ir::Instruction& made, const ir::RealConstant& constant);
    void emit(const ir::Instruction& made, const ir::WordConstant& constant);
    void emit(const ir::Instruction& made, const ir::ReadInput& read);
    void emit(const ir::Instruction& made, const ir::ReadParameter& read);
    void emit(const ir::Instruction& made, const ir::ReadTable& read);
    void emit(const ir::Instruction& made, const ir::Call& call);
    void emit(const ir::Instruction& made, const ir::PointDerivative& derivative);
    void emit(const ir::Instruction& made, const ir::If& choice);
    void emit(const ir::Instruction& made, const ir::For& loop);
    void emit_in_lanes(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop);
    void emit_in_order(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop);
    void repeat(llvm::Value* count, const std::function<void(llvm::PHINode*)>& body);
    void emit_ahead(const std::vector<const ir::Instruction*>& instructions);
    void emit_one_by_one(const ir::Block& body, const LaneLoop& loop, llvm::Value* count,
                         std::vector<llvm::Value*>& carried);
    void take_out_of_lanes(const ir::Block& block, std::map<uint32_t, llvm::AllocaInst*>& rooms);
    void take_out_of_lanes(ir::Value used, std::map<uint32_t, llvm::AllocaInst*>& rooms);
};

} // namespace haptel::jit
