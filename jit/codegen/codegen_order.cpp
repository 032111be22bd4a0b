// Loops whose iterations would be in lanes, in a draft: one after the other, by code that is made sooner.
#include "jit/codegen/codegen_function.h"
#include "jit/codegen/codegen_progress.h"

namespace haptel::jit {

using llvm::Value;
using Kind = Carried::Kind;

// The operations of the form in lanes, one iteration after the other. What a lane of a sum holds is in memory: `sums`
// cells for the first lane, then for the next one.
void FunctionEmitter::emit_in_order(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop)
{
    const uint32_t lanes = module.lanes;
    llvm::Type* const real = builder.getDoubleTy();
    Value* const count = value(made.operands[0]);
    emit_ahead(loop.fixed);
    std::vector<Form> held;
    std::vector<size_t> sums; // which of the carried
    std::vector<Progress> progress;
    for (size_t i = 0; i < loop.carried.size(); ++i) {
        const Carried& one = loop.carried[i];
        held.push_back(forms[body.parameters[i + 1]]);
        Value* const by = one.by == ir::Value{} ? nullptr : value(one.by, held[i]);
        progress.emplace_back(builder, one.kind, type(body.parameters[i + 1]), by, lanes);
        if (one.kind == Kind::sum && forms.is_needed(body.parameters[i + 1])) sums.push_back(i);
    }
    const auto sum_count = static_cast<uint32_t>(sums.size());
    llvm::IRBuilder<> at_entry(&target.getEntryBlock(), target.getEntryBlock().begin());
    llvm::AllocaInst* const cells = at_entry.CreateAlloca(llvm::ArrayType::get(real, lanes * sum_count));
    const auto cell = [&](Value* number) {
        return builder.CreateInBoundsGEP(real, cells, builder.CreateZExt(number, builder.getInt64Ty()));
    };
    const auto plus = [&](Value* number, uint32_t more) { return builder.CreateAdd(number, builder.getInt32(more)); };

    repeat(builder.getInt32(lanes * sum_count),
           [&](llvm::PHINode* number) { builder.CreateStore(llvm::ConstantFP::getNegativeZero(real), cell(number)); });

    // Of what follows from the iteration's number.
    std::vector<Value*> start(loop.carried.size());
    std::vector<llvm::PHINode*> first(loop.carried.size());
    for (size_t i = 0; i < start.size(); ++i)
        if (loop.carried[i].kind != Kind::sum) start[i] = value(made.operands[i + 1], held[i]);
    llvm::BasicBlock* const before = builder.GetInsertBlock();
    repeat(count, [&](llvm::PHINode* iteration) {
        for (size_t i = 0; i < first.size(); ++i) {
            if (!start[i]) continue;
            first[i] = llvm::PHINode::Create(start[i]->getType(), 2, "", iteration);
            first[i]->addIncoming(start[i], before);
        }
        Value* const lane = builder.CreateAnd(iteration, builder.getInt32(lanes - 1));
        Value* const is_first_group = builder.CreateICmpULT(iteration, builder.getInt32(lanes));
        Value* const cells_of_lane = builder.CreateMul(lane, builder.getInt32(sum_count));
        define(body.parameters[0], iteration);
        for (size_t i = 0; i < first.size(); ++i)
            if (first[i]) define(body.parameters[i + 1], progress[i].in_lanes(first[i], lane, is_first_group));
        for (uint32_t k = 0; k < sum_count; ++k)
            define(body.parameters[sums[k] + 1], builder.CreateLoad(real, cell(plus(cells_of_lane, k))));
        const std::vector<Value*> yields = block(body, held);
        for (uint32_t k = 0; k < sum_count; ++k) builder.CreateStore(yields[sums[k]], cell(plus(cells_of_lane, k)));
        Value* const is_last = builder.CreateICmpEQ(lane, builder.getInt32(lanes - 1));
        for (size_t i = 0; i < first.size(); ++i)
            if (first[i])
                first[i]->addIncoming(builder.CreateSelect(is_last, progress[i].in_next_group(first[i]), first[i]),
                                      builder.GetInsertBlock());
    });

    for (uint32_t half = lanes / 2; half > 0; half /= 2) // as sum_of_lanes()
        repeat(builder.getInt32(half * sum_count), [&](llvm::PHINode* number) {
            Value* const other = builder.CreateLoad(real, cell(plus(number, half * sum_count)));
            Value* const low = cell(number);
            builder.CreateStore(builder.CreateFAdd(builder.CreateLoad(real, low), other), low);
        });
    for (uint32_t k = 0; k < sum_count; ++k) {
        Value* const sum = builder.CreateLoad(real, cell(builder.getInt32(k)));
        define(made.results[sums[k]], builder.CreateFAdd(value(made.operands[sums[k] + 1], held[sums[k]]), sum));
    }
}

// A loop that `body` writes: for 0, 1 ... below `count`.
void FunctionEmitter::repeat(Value* count, const std::function<void(llvm::PHINode*)>& body)
{
    llvm::BasicBlock* const before = builder.GetInsertBlock();
    llvm::BasicBlock* const head = new_block("repeat");
    llvm::BasicBlock* const inside = new_block("again");
    llvm::BasicBlock* const after = new_block("repeated");
    builder.CreateBr(head);
    builder.SetInsertPoint(head);
    llvm::PHINode* const number = builder.CreatePHI(builder.getInt32Ty(), 2);
    number->addIncoming(builder.getInt32(0), before);
    builder.CreateCondBr(builder.CreateICmpSLT(number, count), inside, after);
    builder.SetInsertPoint(inside);
    body(number);
    number->addIncoming(builder.CreateAdd(number, builder.getInt32(1)), builder.GetInsertBlock());
    builder.CreateBr(head);
    builder.SetInsertPoint(after);
}

} // namespace haptel::jit
