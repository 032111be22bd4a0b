#include "jit/codegen/codegen_math.h"

#include "jit/codegen/codegen_number.h"
#include "lang/ir/elementary_functions.h"
#include "lang/ir/op_info.h"

#include <llvm/IR/MDBuilder.h>
#include <string>

namespace haptel::jit {

namespace {

using llvm::Value;

constexpr llvm::StringLiteral prefix = "haptel_e.";

uint32_t lanes_of(llvm::Type* type)
{
    const auto* vector = llvm::dyn_cast<llvm::FixedVectorType>(type);
    return vector ? vector->getNumElements() : 1;
}

std::string symbol_of(const ElementaryForm& form)
{
    return prefix.str() + std::string(ir::op_info(form.op).name) +
           (form.is_single ? ".f32"
            : form.narrows ? ".f32.f64"
                           : ".f64") +
           "x" + std::to_string(form.lanes);
}

llvm::Function& declare(llvm::Module& module, const std::string& symbol, const ElementaryForm& form)
{
    if (llvm::Function* known = module.getFunction(symbol)) return *known;
    llvm::LLVMContext& context = module.getContext();
    const auto type = [&](bool is_single) -> llvm::Type* {
        llvm::Type* scalar = is_single ? llvm::Type::getFloatTy(context) : llvm::Type::getDoubleTy(context);
        return form.lanes > 1 ? llvm::FixedVectorType::get(scalar, form.lanes) : scalar;
    };
    const std::vector<llvm::Type*> operands(ir::op_info(form.op).arity, type(form.is_single));
    auto* function =
        llvm::Function::Create(llvm::FunctionType::get(type(form.is_single || form.narrows), operands, false),
                               llvm::GlobalValue::ExternalLinkage, symbol, module);
    function->setCallingConv(llvm::CallingConv::Fast);
    function->setDoesNotThrow();
    function->setDoesNotAccessMemory();
    function->setWillReturn();
    return *function;
}

template <typename F>
Value* applied(llvm::IRBuilder<>& builder, ir::Op op, llvm::Function& function)
{
    llvm::Argument *first = function.arg_begin(), *last = function.arg_end() - 1;
    return ir::elementary::apply(op, Code<F>(builder, first), Code<F>(builder, last)).code();
}

void write_body(llvm::Function& function, const ElementaryForm& form)
{
    llvm::IRBuilder<> builder(llvm::BasicBlock::Create(function.getContext(), "", &function));
    Value* value = form.narrows
                       ? ir::elementary::apply_to_angle(form.op, Code<double>(builder, function.getArg(0))).code()
                   : form.is_single ? applied<float>(builder, form.op, function)
                                    : applied<double>(builder, form.op, function);
    builder.CreateRet(value);
}

} // namespace

Value* call_elementary(llvm::IRBuilder<>& builder, ir::Op op, std::span<Value* const> operands, llvm::Type* result)
{
    const bool is_single = operands[0]->getType()->getScalarType()->isFloatTy();
    const ElementaryForm form{op, is_single, ir::takes_angle(op) && result->isFloatTy() && !is_single,
                              lanes_of(operands[0]->getType())};
    llvm::Function& function = declare(*builder.GetInsertBlock()->getModule(), symbol_of(form), form);
    llvm::CallInst* call = builder.CreateCall(&function, llvm::ArrayRef(operands.data(), operands.size()));
    call->setCallingConv(llvm::CallingConv::Fast);
    return call;
}

ElementaryForms elementary_calls(const llvm::Module& module)
{
    ElementaryForms found;
    for (const llvm::Function& function : module) {
        llvm::StringRef name = function.getName();
        if (!function.isDeclaration() || !name.consume_front(prefix)) continue;
        const std::optional<ir::Op> op = ir::op_named(std::string_view(name.split('.').first));
        llvm::Type* operand = function.getArg(0)->getType();
        const bool is_single = operand->getScalarType()->isFloatTy();
        const bool narrows = !is_single && function.getReturnType()->getScalarType()->isFloatTy();
        found[function.getName().str()] = {*op, is_single, narrows, lanes_of(operand)};
    }
    return found;
}

void write_elementary(llvm::Module& module)
{
    for (const auto& [symbol, form] : elementary_calls(module)) {
        llvm::Function& function = *module.getFunction(symbol);
        function.setLinkage(llvm::GlobalValue::InternalLinkage);
        if (form.lanes > 1) function.addFnAttr(llvm::Attribute::NoInline); // it fills the registers by itself
        write_body(function, form);
    }
}

std::unique_ptr<llvm::Module> generate_elementary(const std::string& symbol, const ElementaryForm& form,
                                                  llvm::LLVMContext& context)
{
    auto module = std::make_unique<llvm::Module>(symbol, context);
    write_body(declare(*module, symbol, form), form);
    return module;
}

// As a call through memory: it is a hundred times as long as the rest, whatever the lanes.
void reduce_where(CodeTruth condition, Code<double> a, ir::elementary::Angle<Code<double>>& angle)
{
    llvm::IRBuilder<>& builder = a.at();
    llvm::LLVMContext& context = builder.getContext();
    llvm::BasicBlock* before = builder.GetInsertBlock();
    llvm::Function* function = before->getParent();
    llvm::Module* module = function->getParent();
    const uint32_t lanes = lanes_of(a.code()->getType());
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
