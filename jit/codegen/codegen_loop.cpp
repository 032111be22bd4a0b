// Loops: one iteration after the other, or for one point several of them in the lanes of a register.
#include "jit/codegen/codegen_function.h"

#include <llvm/Analysis/VectorUtils.h>

namespace haptel::jit {

using llvm::Value;
using Kind = Carried::Kind;

Values repeat(llvm::IRBuilder<>& builder, Value* count, uint32_t step, const Values& initial,
              llvm::function_ref<Values(Value* number, const Values& values)> body)
{
    llvm::Type* const type = count->getType();
    llvm::BasicBlock* const before = builder.GetInsertBlock();
    const auto new_block = [&](const char* name) {
        return llvm::BasicBlock::Create(builder.getContext(), name, before->getParent());
    };
    llvm::BasicBlock* const head = new_block("loop");
    llvm::BasicBlock* const inside = new_block("body");
    llvm::BasicBlock* const after = new_block("done");
    builder.CreateBr(head);
    builder.SetInsertPoint(head);
    llvm::PHINode* const number = builder.CreatePHI(type, 2);
    number->addIncoming(llvm::ConstantInt::get(type, 0), before);
    Values values;
    for (Value* first : initial) {
        values.push_back(builder.CreatePHI(first->getType(), 2));
        llvm::cast<llvm::PHINode>(values.back())->addIncoming(first, before);
    }
    builder.CreateCondBr(builder.CreateICmpSLT(number, count), inside, after);
    builder.SetInsertPoint(inside);
    const Values next = body(number, values);
    Value* const following = builder.CreateAdd(number, llvm::ConstantInt::get(type, step), "", false, step == 1);
    number->addIncoming(following, builder.GetInsertBlock());
    for (size_t i = 0; i < next.size(); ++i)
        llvm::cast<llvm::PHINode>(values[i])->addIncoming(next[i], builder.GetInsertBlock());
    builder.CreateBr(head);
    builder.SetInsertPoint(after);
    return values;
}

Values FunctionEmitter::emit(const ir::Instruction& made, const ir::For& loop)
{
    const ir::Block& body = loop.body[0];
    if (const auto found = forms.loops.find(&loop); found != forms.loops.end())
        return found->second.is_ordered ? emit_in_order(made, body, found->second)
                                        : emit_in_lanes(made, body, found->second);
    Value* const count = value(made.operands[0]);
    const bool count_varies = forms[made.operands[0]].in_lanes;
    Value* const largest = count_varies ? builder.CreateIntMaxReduce(count, true) : count;
    Values initial;
    std::vector<Form> held;
    for (size_t i = 1; i < body.parameters.size(); ++i) {
        held.push_back(forms[body.parameters[i]]);
        initial.push_back(value(made.operands[i], held.back()));
    }
    return repeat(builder, largest, 1, initial, [&](Value* iteration, const Values& carried) {
        define(body.parameters[0], iteration);
        for (size_t i = 0; i < carried.size(); ++i) define(body.parameters[i + 1], carried[i]);
        Values next = block(body, held);
        if (count_varies) {
            Value* goes_on = builder.CreateICmpSLT(builder.CreateVectorSplat(module.lanes, iteration), count);
            for (size_t i = 0; i < next.size(); ++i) next[i] = builder.CreateSelect(goes_on, next[i], carried[i]);
        }
        return next;
    });
}

namespace {

// A carried value that follows from the iteration's number: from what it is in the first of a group of lanes to what it
// is in each, and in the first of the next group. Products go by doubling: three multiplications for eight lanes. Where
// iterations follow one another, the lane is one number.
class Progress {
public:
    // `amount`: one value for all lanes, null where there is none.
    Progress(llvm::IRBuilder<>& to, Kind of, Value* amount, uint32_t lane_count)
        : builder(to)
        , kind(of)
        , is_real(amount && amount->getType()->isFloatingPointTy())
        , lanes(lane_count)
        , by(kind == Kind::back ? negated(amount) : amount)
    {
        if (kind != Kind::factor) return;
        powers = {by};
        while (1u << powers.size() <= lanes) powers.push_back(times(powers.back(), powers.back()));
    }
    bool is_known() const { return kind != Kind::sum && kind != Kind::serial; }

    // `lane`: the lane's number, not above the last iteration.
    Value* in_lanes(Value* first, Value* lane, Value* is_first_group)
    {
        Value* all = spread(first, lane);
        if (kind == Kind::step || kind == Kind::back) {
            Value* const amount = spread(by, lane);
            return plus(all, times(amount, is_real ? builder.CreateUIToFP(lane, amount->getType()) : lane));
        }
        if (kind == Kind::replaced) {
            Value* const is_first = builder.CreateAnd(builder.CreateIsNull(lane), spread(is_first_group, lane));
            return builder.CreateSelect(is_first, all, spread(by, lane));
        }
        for (uint32_t bit = 0; kind == Kind::factor && 1u << bit < lanes; ++bit) {
            Value* const masked = builder.CreateAnd(lane, llvm::ConstantInt::get(lane->getType(), 1u << bit));
            Value* const more = times(all, spread(powers[bit], lane));
            all = builder.CreateSelect(builder.CreateIsNotNull(masked), more, all);
        }
        return kind == Kind::factor ? all : first;
    }
    Value* in_next_group(Value* first)
    {
        if (kind == Kind::factor) return times(first, powers.back());
        if (kind != Kind::step && kind != Kind::back) return first;
        llvm::Type* const type = by->getType();
        return plus(first,
                    times(by, is_real ? llvm::ConstantFP::get(type, lanes) : llvm::ConstantInt::get(type, lanes)));
    }

private:
    llvm::IRBuilder<>& builder;
    const Kind kind;
    const bool is_real; // not words
    const uint32_t lanes;
    Value* const by;
    Values powers; // by^1, by^2, by^4 ... by^lanes

    Value* plus(Value* a, Value* b) { return is_real ? builder.CreateFAdd(a, b) : builder.CreateAdd(a, b); }
    Value* times(Value* a, Value* b) { return is_real ? builder.CreateFMul(a, b) : builder.CreateMul(a, b); }
    Value* negated(Value* a) { return is_real ? builder.CreateFNeg(a) : builder.CreateNeg(a); }
    Value* spread(Value* one, Value* lane)
    {
        return lane->getType()->isVectorTy() ? builder.CreateVectorSplat(lanes, one) : one;
    }
};

// Halves onto halves: an order that does not depend on the code around.
Value* sum_of_lanes(llvm::IRBuilder<>& builder, Value* lanes, uint32_t count)
{
    for (uint32_t half = count / 2; half > 0; half /= 2)
        lanes = builder.CreateFAdd(builder.CreateShuffleVector(lanes, llvm::createSequentialMask(0, half, 0)),
                                   builder.CreateShuffleVector(lanes, llvm::createSequentialMask(half, half, 0)));
    return builder.CreateExtractElement(lanes, uint64_t{0});
}

} // namespace

// Groups of as many iterations as there are lanes; in the last group lanes may be idle. An idle lane stands at the last
// iteration, so that nothing in it is out of its range, and adds nothing. A sum's lanes start at -0, which adds
// nothing.
Values FunctionEmitter::emit_in_lanes(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop)
{
    const uint32_t lanes = module.lanes;
    Value* const count = value(made.operands[0]);
    emit_ahead(loop.fixed);
    std::vector<Form> held, alone;
    Values initial; // scalars, but a sum's
    std::vector<Progress> progress;
    for (size_t i = 0; i < loop.carried.size(); ++i) {
        const auto& [kind, by] = loop.carried[i];
        const ir::Value parameter = body.parameters[i + 1];
        held.push_back(forms[parameter]);
        alone.push_back({false, held[i].is_single});
        progress.emplace_back(builder, kind, by == ir::Value{} ? nullptr : value(by, alone[i]), lanes);
        initial.push_back(kind == Kind::sum ? llvm::ConstantFP::getNegativeZero(type(parameter))
                                            : value(made.operands[i + 1], alone[i]));
    }
    Values results = repeat(builder, count, lanes, initial, [&](Value* first, const Values& carried) {
        Value* const step = builder.CreateStepVector(llvm::FixedVectorType::get(builder.getInt32Ty(), lanes));
        Value* const left = builder.CreateSub(count, first);
        Value* const is_busy = builder.CreateICmpSLT(step, builder.CreateVectorSplat(lanes, left));
        Value* const last = builder.CreateVectorSplat(lanes, builder.CreateSub(left, builder.getInt32(1)));
        Value* const lane = builder.CreateBinaryIntrinsic(llvm::Intrinsic::smin, step, last);
        Value* const is_first_group = builder.CreateIsNull(first);
        define(body.parameters[0], builder.CreateAdd(builder.CreateVectorSplat(lanes, first), lane));
        for (size_t i = 0; i < carried.size(); ++i)
            define(body.parameters[i + 1],
                   progress[i].is_known() ? progress[i].in_lanes(carried[i], lane, is_first_group) : carried[i]);
        Values next = carried;
        if (loop.waits.empty()) {
            next = block(body, held);
            for (size_t i = 0; i < carried.size(); ++i)
                if (!progress[i].is_known()) next[i] = builder.CreateSelect(is_busy, next[i], carried[i]);
        } else {
            emit_ahead(loop.side_by_side);
            Value* const busy = builder.CreateBinaryIntrinsic(llvm::Intrinsic::smin, left, builder.getInt32(lanes));
            next = emit_one_by_one(body, loop, busy, carried);
        }
        for (size_t i = 0; i < carried.size(); ++i)
            if (progress[i].is_known()) next[i] = progress[i].in_next_group(carried[i]);
        return next;
    });
    for (size_t i = 0; i < results.size(); ++i)
        if (loop.carried[i].kind == Kind::sum)
            results[i] =
                builder.CreateFAdd(value(made.operands[i + 1], alone[i]), sum_of_lanes(builder, results[i], lanes));
    return results; // of what is known nobody asks for it
}

// What waits for serial values, `count` iterations of it: what the lanes hold is laid in memory and fetched lane by
// lane.
Values FunctionEmitter::emit_one_by_one(const ir::Block& body, const LaneLoop& loop, Value* count, Values carried)
{
    Rooms rooms;
    take_out_of_lanes(body, rooms);
    std::vector<size_t> serial; // which of the carried
    Values initial;
    for (size_t i = 0; i < carried.size(); ++i) {
        if (loop.carried[i].kind != Kind::serial) continue;
        take_out_of_lanes(body.yields[i], rooms);
        serial.push_back(i);
        initial.push_back(carried[i]);
    }
    const Values last = repeat(builder, count, 1, initial, [&](Value* lane, const Values& held) {
        for (size_t k = 0; k < serial.size(); ++k) define(body.parameters[serial[k] + 1], held[k]);
        for (const auto& [index, room] : rooms) {
            llvm::Type* const element = room->getAllocatedType()->getArrayElementType();
            Value* const cell =
                builder.CreateInBoundsGEP(element, room, builder.CreateZExt(lane, builder.getInt64Ty()));
            Value* const fetched = builder.CreateLoad(element, cell);
            const bool is_boolean = source.value_types[index] == ir::Type::boolean;
            values[index] = is_boolean ? builder.CreateTrunc(fetched, builder.getInt1Ty()) : fetched;
        }
        emit_rest(body);
        Values next;
        for (size_t i : serial) next.push_back(value(body.yields[i], forms[body.parameters[i + 1]]));
        return next;
    });
    for (size_t k = 0; k < serial.size(); ++k) carried[serial[k]] = last[k];
    return carried;
}

// All that the block's remaining instructions use, and the factors of products that they may be fused with.
void FunctionEmitter::take_out_of_lanes(const ir::Block& from, Rooms& rooms)
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

void FunctionEmitter::take_out_of_lanes(ir::Value used, Rooms& rooms)
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
    llvm::AllocaInst* const room = room_for(lanes->getType()->getScalarType(), module.lanes);
    room->setAlignment(llvm::Align(64));
    builder.CreateStore(lanes, room);
    rooms.emplace(used.index, room);
}

llvm::AllocaInst* FunctionEmitter::room_for(llvm::Type* element, uint32_t count)
{
    llvm::BasicBlock& entry = builder.GetInsertBlock()->getParent()->getEntryBlock();
    return llvm::IRBuilder<>(&entry, entry.begin()).CreateAlloca(llvm::ArrayType::get(element, count));
}

// A draft's: the operations of the form in lanes, one iteration after the other, by code that is made sooner. What a
// lane of a sum holds is in memory: `sums` cells for the first lane, then for the next one.
Values FunctionEmitter::emit_in_order(const ir::Instruction& made, const ir::Block& body, const LaneLoop& loop)
{
    const uint32_t lanes = module.lanes;
    llvm::Type* const real = builder.getDoubleTy();
    Value* const count = value(made.operands[0]);
    emit_ahead(loop.fixed);
    std::vector<Form> held;
    std::vector<size_t> known, sums; // which of the carried
    Values initial;                  // of the known ones
    std::vector<Progress> progress;
    for (size_t i = 0; i < loop.carried.size(); ++i) {
        const auto& [kind, by] = loop.carried[i];
        held.push_back(forms[body.parameters[i + 1]]);
        progress.emplace_back(builder, kind, by == ir::Value{} ? nullptr : value(by, held[i]), lanes);
        if (kind != Kind::sum) {
            known.push_back(i);
            initial.push_back(value(made.operands[i + 1], held[i]));
        } else if (forms.is_needed(body.parameters[i + 1])) {
            sums.push_back(i);
        }
    }
    const auto sum_count = static_cast<uint32_t>(sums.size());
    llvm::AllocaInst* const cells = room_for(real, lanes * sum_count);
    const auto cell = [&](Value* number, uint32_t more = 0) {
        if (more > 0) number = builder.CreateAdd(number, builder.getInt32(more));
        return builder.CreateInBoundsGEP(real, cells, builder.CreateZExt(number, builder.getInt64Ty()));
    };

    repeat(builder, builder.getInt32(lanes * sum_count), 1, {}, [&](Value* number, const Values&) {
        builder.CreateStore(llvm::ConstantFP::getNegativeZero(real), cell(number));
        return Values{};
    });
    repeat(builder, count, 1, initial, [&](Value* iteration, const Values& first) {
        Value* const lane = builder.CreateAnd(iteration, builder.getInt32(lanes - 1));
        Value* const is_first_group = builder.CreateICmpULT(iteration, builder.getInt32(lanes));
        Value* const cells_of_lane = builder.CreateMul(lane, builder.getInt32(sum_count));
        define(body.parameters[0], iteration);
        for (size_t k = 0; k < known.size(); ++k)
            define(body.parameters[known[k] + 1], progress[known[k]].in_lanes(first[k], lane, is_first_group));
        for (uint32_t k = 0; k < sum_count; ++k)
            define(body.parameters[sums[k] + 1], builder.CreateLoad(real, cell(cells_of_lane, k)));
        const Values yields = block(body, held);
        for (uint32_t k = 0; k < sum_count; ++k) builder.CreateStore(yields[sums[k]], cell(cells_of_lane, k));
        Value* const is_last = builder.CreateICmpEQ(lane, builder.getInt32(lanes - 1));
        Values next;
        for (size_t k = 0; k < known.size(); ++k)
            next.push_back(builder.CreateSelect(is_last, progress[known[k]].in_next_group(first[k]), first[k]));
        return next;
    });
    for (uint32_t half = lanes / 2; half > 0; half /= 2) // as sum_of_lanes()
        repeat(builder, builder.getInt32(half * sum_count), 1, {}, [&](Value* number, const Values&) {
            Value* const other = builder.CreateLoad(real, cell(number, half * sum_count));
            Value* const low = cell(number);
            builder.CreateStore(builder.CreateFAdd(builder.CreateLoad(real, low), other), low);
            return Values{};
        });
    Values results(loop.carried.size());
    for (uint32_t k = 0; k < sum_count; ++k) {
        Value* const sum = builder.CreateLoad(real, cell(builder.getInt32(k)));
        results[sums[k]] = builder.CreateFAdd(value(made.operands[sums[k] + 1], held[sums[k]]), sum);
    }
    return results;
}

} // namespace haptel::jit
