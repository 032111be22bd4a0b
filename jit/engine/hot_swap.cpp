#include "jit/engine/hot_swap.h"

namespace haptel::jit {

std::string slot_of(const EntryPoint& entry)
{
    return "slot of " + symbol_of(entry);
}

void make_replaceable(llvm::Module& module, std::span<const EntryPoint> entries)
{
    for (const EntryPoint& entry : entries) {
        llvm::Function* const body = module.getFunction(symbol_of(entry));
        body->setName("body of " + symbol_of(entry));
        body->setLinkage(llvm::GlobalValue::InternalLinkage);
        llvm::Type* const pointer = llvm::PointerType::getUnqual(module.getContext());
        auto* slot =
            new llvm::GlobalVariable(module, pointer, false, llvm::GlobalValue::ExternalLinkage, body, slot_of(entry));
        slot->setAlignment(llvm::Align(alignof(void*)));

        llvm::Function* const jump = llvm::Function::Create(body->getFunctionType(), llvm::GlobalValue::ExternalLinkage,
                                                            symbol_of(entry), module);
        jump->setDoesNotThrow();
        llvm::IRBuilder<> builder(llvm::BasicBlock::Create(module.getContext(), "", jump));
        llvm::LoadInst* code = builder.CreateLoad(pointer, slot);
        code->setAlignment(llvm::Align(alignof(void*)));
        code->setAtomic(llvm::AtomicOrdering::Acquire);
        std::vector<llvm::Value*> arguments;
        for (llvm::Argument& argument : jump->args()) arguments.push_back(&argument);
        builder.CreateCall(body->getFunctionType(), code, arguments)->setTailCallKind(llvm::CallInst::TCK_MustTail);
        builder.CreateRetVoid();
    }
}

} // namespace haptel::jit
