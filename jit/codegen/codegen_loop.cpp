// Loops: one iteration after the other, or for one point several of them in the lanes of a register.
#include "jit/codegen/codegen_function.h"
#include "jit/codegen/codegen_progress.h"

#include <numeric>

namespace haptel::jit {

using llvm::Value;
using Kind = Carried::Kind;

void FunctionEmitter::emit(const ir::Instruction& made, const ir::For& loop)
{
    const ir::Block& body = loop.body[0];
    if (const auto in_lanes = forms.loops.find(&loop); in_lanes != forms.loops.end())
        return emit_in_lanes(made, body, in_lanes->second);
    if (const auto in_order = forms.ordered.find(&loop); in_order != forms.ordered.end())
        return emit_in_order(made, body, in_order->second);
    Value* const count = value(made.operands[0]);
    const bool count_varies = forms[made.operands[0]].in_lanes;
    Value* const largest = count_varies ? builder.CreateIntMaxReduce(count, true) : count;
    std::vector<Value*> initial;
    std::vector<Form> held;
    for (size_t i = 1; i < body.parameters.size(); ++i) {
        held.push_back(forms[body.parameters[i]]);
        initial.push_back(value(made.operands[i], held.back()));
    }
    llvm::BasicBlock* before = builder.GetInsertBlock();
    llvm::BasicBlock* head = new_block("loop");
    llvm::BasicBlock* inside = new_block("body");
    llvm::BasicBlock* after = new_block("done");
    builder.CreateBr(head);

    builder.SetInsertPoint(head);
    llvm::PHINode* iteration = builder.CreatePHI(builder.getInt32Ty(), 2);
    iteration->addIncoming(builder.getInt32(0), before);
    define(body.parameters[0], iteration);
    std::vector<llvm::PHINode*> carried;
    for (size_t i = 0; i < initial.size(); ++i) {
        carried.push_back(builder.CreatePHI(initial[i]->getType(), 2));
        carried[i]->addIncoming(initial[i], before);
        define(body.parameters[i + 1], carried[i]);
    }
    builder.CreateCondBr(builder.CreateICmpSLT(iteration, largest), inside, after);

    builder.SetInsertPoint(inside);
    std::vector<Value*> next = block(body, held);
    if (count_varies) {
        Value* goes_on = builder.CreateICmpSLT(builder.CreateVectorSplat(module.lanes, iteration), count);
        for (size_t i = 0; i < next.size(); ++i) next[i] = builder.CreateSelect(goes_on, next[i], carried[i]);
    }
    iteration->addIncoming(builder.CreateNSWAdd(iteration, builder.getInt32(1)), builder.GetInsertBlock());
    for (size_t i = 0; i < next.size(); ++i) carried[i]->addIncoming(next[i], builder.GetInsertBlock());
    builder.CreateBr(head);

    builder.SetInsertPoint(after);
    for (size_t i = 0; i < made.results.size(); ++i) define(made.results[i], carried[i]);
}

namespace {

// Halves onto halves: an order that does not depend on the code around.
Value* sum_of_lanes(llvm::IRBuilder<>& builder, Value* lanes, uint32_t count)
{
    for (uint32_t half = count / 2; half > 0; half /= 2) {
        std::vector<int> low(half), high(half);
        std::iota(low.begin(), low.end(), 0);
        std::iota(high.begin(), high.end(), static_cast<int>(half));
        lanes = builder.CreateFAdd(builder.CreateShuffleVector(lanes, low), builder.CreateShuffleVector(lanes, high));
    }
    return builder.CreateExtractElement(lanes, uint64_t{0});
}

} // namespace

// Groups of as many iterations as there are lanes; in the last group lanes may be idle. An idle lane stands at the last
// iteration, so that nothing in it is out of its range, and adds nothing. A sum's lanes start at -0, which adds
// nothing.
void FunctionEmitter::emit_in_lanes(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop)
{
    const uint32_t lanes = module.lanes;
    Value* const count = value(made.operands[0]);
    emit_ahead(loop.fixed);
    const size_t carried_count = loop.carried.size();
    std::vector<Form> held;
    std::vector<Value*> initial; // scalars, but a sum's
    std::vector<Progress> progress;
    for (size_t i = 0; i < carried_count; ++i) {
        const Carried& one = loop.carried[i];
        const ir::Value parameter = body.parameters[i + 1];
        held.push_back(forms[parameter]);
        const Form alone{false, held[i].is_single};
        llvm::Type* element = module.type(source.type(parameter), alone);
        const bool has_amount = one.by != ir::Value{};
        progress.emplace_back(builder, one.kind, element, has_amount ? value(one.by, alone) : nullptr, lanes);
        initial.push_back(one.kind == Kind::sum ? llvm::ConstantFP::getNegativeZero(type(parameter))
                                                : value(made.operands[i + 1], alone));
    }

    llvm::BasicBlock* before = builder.GetInsertBlock();
    llvm::BasicBlock* head = new_block("iterations");
    llvm::BasicBlock* inside = new_block("group");
    llvm::BasicBlock* after = new_block("summed");
    builder.CreateBr(head);
    builder.SetInsertPoint(head);
    llvm::PHINode* first = builder.CreatePHI(builder.getInt32Ty(), 2);
    first->addIncoming(builder.getInt32(0), before);
    std::vector<llvm::PHINode*> carried;
    for (Value* start : initial) {
        carried.push_back(builder.CreatePHI(start->getType(), 2));
        carried.back()->addIncoming(start, before);
    }
    builder.CreateCondBr(builder.CreateICmpSLT(first, count), inside, after);

    builder.SetInsertPoint(inside);
    Value* const step = builder.CreateStepVector(llvm::FixedVectorType::get(builder.getInt32Ty(), lanes));
    Value* const left = builder.CreateSub(count, first);
    Value* const is_busy = builder.CreateICmpSLT(step, builder.CreateVectorSplat(lanes, left));
    Value* const last = builder.CreateVectorSplat(lanes, builder.CreateSub(left, builder.getInt32(1)));
    Value* const lane = builder.CreateBinaryIntrinsic(llvm::Intrinsic::smin, step, last);
    Value* const is_first_group = builder.CreateICmpEQ(first, builder.getInt32(0));
    define(body.parameters[0], builder.CreateAdd(builder.CreateVectorSplat(lanes, first), lane));
    for (size_t i = 0; i < carried_count; ++i)
        define(body.parameters[i + 1], loop.carried[i].kind == Kind::sum || loop.carried[i].kind == Kind::serial
                                           ? carried[i]
                                           : progress[i].in_lanes(carried[i], lane, is_first_group));
    std::vector<Value*> next(carried.begin(), carried.end());
    if (loop.waits.empty()) {
        const std::vector<Value*> yields = block(body, held);
        for (size_t i = 0; i < carried_count; ++i)
            if (loop.carried[i].kind == Kind::sum) next[i] = builder.CreateSelect(is_busy, yields[i], next[i]);
    } else {
        emit_ahead(loop.side_by_side);
        Value* const most = builder.getInt32(lanes);
        emit_one_by_one(body, loop, builder.CreateBinaryIntrinsic(llvm::Intrinsic::smin, left, most), next);
    }
    for (size_t i = 0; i < carried_count; ++i) {
        const bool is_known = loop.carried[i].kind != Kind::sum && loop.carried[i].kind != Kind::serial;
        if (is_known) next[i] = progress[i].in_next_group(carried[i]);
        carried[i]->addIncoming(next[i], builder.GetInsertBlock());
    }
    first->addIncoming(builder.CreateAdd(first, builder.getInt32(lanes)), builder.GetInsertBlock());
    builder.CreateBr(head);

    builder.SetInsertPoint(after);
    for (size_t i = 0; i < carried_count; ++i) {
        if (loop.carried[i].kind == Kind::serial) define(made.results[i], carried[i]);
        if (loop.carried[i].kind != Kind::sum) continue;
        const Form alone{false, held[i].is_single};
        define(made.results[i],
               builder.CreateFAdd(value(made.operands[i + 1], alone), sum_of_lanes(builder, carried[i], lanes)));
    }
}

void FunctionEmitter::emit_ahead(const std::vector<const ir::Instruction*>& instructions)
{
    for (const ir::Instruction* one : instructions) {
        emit(*one);
        done.insert(one);
    }
}

// What waits for serial values, `count` iterations of it: what the lanes hold is laid in memory and fetched lane by
// lane.
void FunctionEmitter::emit_one_by_one(const ir::Block& body, const LaneLoop& loop, Value* count,
                                      std::vector<Value*>& carried)
{
    std::map<uint32_t, llvm::AllocaInst*> rooms; // by value
    take_out_of_lanes(body, rooms);
    for (size_t i = 0; i < carried.size(); ++i)
        if (loop.carried[i].kind == Kind::serial) take_out_of_lanes(body.yields[i], rooms);

    llvm::BasicBlock* before = builder.GetInsertBlock();
    llvm::BasicBlock* one = new_block("one");
    llvm::BasicBlock* after = new_block("all");
    builder.CreateBr(one); // a group has an iteration at least
    builder.SetInsertPoint(one);
    llvm::PHINode* lane = builder.CreatePHI(builder.getInt32Ty(), 2);
    lane->addIncoming(builder.getInt32(0), before);
    std::vector<llvm::PHINode*> held(carried.size());
    for (size_t i = 0; i < carried.size(); ++i) {
        if (loop.carried[i].kind != Kind::serial) continue;
        held[i] = builder.CreatePHI(carried[i]->getType(), 2);
        held[i]->addIncoming(carried[i], before);
        define(body.parameters[i + 1], held[i]);
    }
    for (const auto& [index, room] : rooms) {
        llvm::Type* element = llvm::cast<llvm::ArrayType>(room->getAllocatedType())->getElementType();
        Value* cell = builder.CreateInBoundsGEP(element, room, builder.CreateZExt(lane, builder.getInt64Ty()));
        Value* fetched = builder.CreateLoad(element, cell);
        const bool is_boolean = source.value_types[index] == ir::Type::boolean;
        values[index] = is_boolean ? builder.CreateTrunc(fetched, builder.getInt1Ty()) : fetched;
    }
    for (const ir::Instruction& instruction : body.instructions)
        if (!done.contains(&instruction)) emit(instruction);
    Value* const next = builder.CreateAdd(lane, builder.getInt32(1));
    for (size_t i = 0; i < carried.size(); ++i) {
        if (!held[i]) continue;
        carried[i] = value(body.yields[i], forms[body.parameters[i + 1]]);
        held[i]->addIncoming(carried[i], builder.GetInsertBlock());
    }
    lane->addIncoming(next, builder.GetInsertBlock());
    builder.CreateCondBr(builder.CreateICmpSLT(next, count), one, after);
    builder.SetInsertPoint(after);
}

// All that the block's remaining instructions use, and the factors of products that they may be fused with.
void FunctionEmitter::take_out_of_lanes(const ir::Block& from, std::map<uint32_t, llvm::AllocaInst*>& rooms)
{
    for (const ir::Instruction& made : from.instructions) {
        if (done.contains(&made) || !is_needed(made)) continue;
        for (ir::Value used : made.operands) {
            take_out_of_lanes(used, rooms);
            if (const ir::Instruction* product = module.fuses() ? products[used.index] : nullptr)
                for (ir::Value factor : product->operands) take_out_of_lanes(factor, rooms);
        }
        for (const ir::Block& inner : ir::blocks_of(made)) {
            take_out_of_lanes(inner, rooms);
            for (ir::Value yield : inner.yields) take_out_of_lanes(yield, rooms);
        }
    }
}

void FunctionEmitter::take_out_of_lanes(ir::Value used, std::map<uint32_t, llvm::AllocaInst*>& rooms)
{
    if (!forms[used].in_lanes) return;
    Value* lanes = value(used);
    forms.in_lanes[used.index] = false;
    if (!forms.is_needed(used)) {
        values[used.index] = nullptr;
        return;
    }
    if (source.type(used) == ir::Type::boolean)
        lanes = builder.CreateZExt(lanes, llvm::FixedVectorType::get(builder.getInt8Ty(), module.lanes));
    llvm::IRBuilder<> at_entry(&target.getEntryBlock(), target.getEntryBlock().begin());
    llvm::AllocaInst* room =
        at_entry.CreateAlloca(llvm::ArrayType::get(lanes->getType()->getScalarType(), module.lanes));
    room->setAlignment(llvm::Align(64));
    builder.CreateStore(lanes, room);
    rooms.emplace(used.index, room);
}

} // namespace haptel::jit
