#include "jit/codegen_math.h"

#include "jit/codegen_number.h"
#include "lang/ir/elementary.h"
#include "lang/ir/elementary_functions.h"
#include "lang/ir/op_info.h"

#include <llvm/IR/MDBuilder.h>
#include <string>

namespace haptel::jit {

namespace {

using llvm::Value;

uint32_t lanes_of(Value* value)
{
    const auto* vector = llvm::dyn_cast<llvm::FixedVectorType>(value->getType());
    return vector ? vector->getNumElements() : 1;
}

std::string name_of(ir::Op op, Value* operand, bool narrows)
{
    const bool is_single = operand->getType()->getScalarType()->isFloatTy();
    return "elementary." + std::string(ir::op_info(op).name) +
           (is_single ? ".f32"
            : narrows ? ".f32.f64"
                      : ".f64") +
           "x" + std::to_string(lanes_of(operand));
}

template <typename F>
Value* applied(llvm::IRBuilder<>& builder, ir::Op op, llvm::Function& function)
{
    llvm::Argument *first = function.arg_begin(), *last = function.arg_end() - 1;
    return ir::elementary::apply(op, Code<F>(builder, first), Code<F>(builder, last)).code();
}

llvm::Function* made(llvm::Module& module, const std::string& name, ir::Op op, std::span<Value* const> operands,
                     bool narrows)
{
    llvm::LLVMContext& context = module.getContext();
    std::vector<llvm::Type*> types;
    for (Value* operand : operands) types.push_back(operand->getType());
    llvm::Type* result = narrows ? types[0]->getWithNewType(llvm::Type::getFloatTy(context)) : types[0];
    auto* function = llvm::Function::Create(llvm::FunctionType::get(result, types, false),
                                            llvm::GlobalValue::InternalLinkage, name, module);
    function->setCallingConv(llvm::CallingConv::Fast);
    function->setDoesNotThrow();
    function->setDoesNotAccessMemory();
    function->setWillReturn();
    llvm::IRBuilder<> builder(llvm::BasicBlock::Create(context, "", function));
    const bool is_single = types[0]->getScalarType()->isFloatTy();
    Value* value = narrows     ? ir::elementary::apply_to_angle(op, Code<double>(builder, function->getArg(0))).code()
                   : is_single ? applied<float>(builder, op, *function)
                               : applied<double>(builder, op, *function);
    builder.CreateRet(value);
    return function;
}

} // namespace

Value* call_elementary(llvm::IRBuilder<>& builder, ir::Op op, std::span<Value* const> operands, llvm::Type* result)
{
    llvm::Module& module = *builder.GetInsertBlock()->getModule();
    const bool narrows =
        ir::takes_angle(op) && result->isFloatTy() && operands[0]->getType()->getScalarType()->isDoubleTy();
    const std::string name = name_of(op, operands[0], narrows);
    llvm::Function* function = module.getFunction(name);
    if (!function) function = made(module, name, op, operands, narrows);
    llvm::CallInst* call = builder.CreateCall(function, llvm::ArrayRef(operands.data(), operands.size()));
    call->setCallingConv(llvm::CallingConv::Fast);
    return call;
}

// As a call through memory: it is a hundred times as long as the rest, whatever the lanes.
void reduce_where(CodeTruth condition, Code<double> a, ir::elementary::Angle<Code<double>>& angle)
{
    llvm::IRBuilder<>& builder = a.at();
    llvm::LLVMContext& context = builder.getContext();
    llvm::BasicBlock* before = builder.GetInsertBlock();
    llvm::Function* function = before->getParent();
    llvm::Module* module = function->getParent();
    const uint32_t lanes = lanes_of(a.code());
    Value* const any = lanes > 1 ? builder.CreateOrReduce(condition.value) : condition.value;
    llvm::BasicBlock* huge = llvm::BasicBlock::Create(context, "huge", function);
    llvm::BasicBlock* after = llvm::BasicBlock::Create(context, "reduced", function);
    builder.CreateCondBr(any, huge, after, llvm::MDBuilder(context).createUnlikelyBranchWeights());

    llvm::IRBuilder<> start(&function->getEntryBlock(), function->getEntryBlock().begin());
    Value* places[4];
    for (Value*& place : places) place = start.CreateAlloca(a.code()->getType());
    llvm::Type* pointer = builder.getPtrTy();
    auto* type =
        llvm::FunctionType::get(builder.getVoidTy(), {pointer, builder.getInt32Ty(), pointer, pointer, pointer}, false);
    auto* reduce = llvm::cast<llvm::Function>(module->getOrInsertFunction("haptel_reduce_angles", type).getCallee());
    reduce->setDoesNotThrow();
    reduce->setMemoryEffects(llvm::MemoryEffects::argMemOnly());
    reduce->setWillReturn();
    builder.SetInsertPoint(huge);
    builder.CreateStore(a.code(), places[0]);
    builder.CreateCall(reduce, {places[0], builder.getInt32(lanes), places[1], places[2], places[3]});
    Code<double>* const parts[] = {&angle.quarters, &angle.high, &angle.low};
    Value* chosen[3];
    for (size_t i = 0; i < 3; ++i) {
        Value* loaded = builder.CreateLoad(a.code()->getType(), places[i + 1]);
        chosen[i] = builder.CreateSelect(condition.value, loaded, parts[i]->code());
    }
    builder.CreateBr(after);
    builder.SetInsertPoint(after);
    for (size_t i = 0; i < 3; ++i) {
        llvm::PHINode* phi = builder.CreatePHI(a.code()->getType(), 2);
        phi->addIncoming(parts[i]->code(), before);
        phi->addIncoming(chosen[i], huge);
        *parts[i] = Code<double>(builder, phi);
    }
}

} // namespace haptel::jit
