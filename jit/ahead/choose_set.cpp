#include "jit/ahead/choose_set.h"

#include "jit/codegen/llvm.h"
#include "lang/abi/abi.h"

#include <algorithm>
#include <llvm/IR/InlineAsm.h>
#include <llvm/Transforms/Utils/ModuleUtils.h>

namespace haptel::jit {

namespace {

using llvm::Value;

// Bits that a processor with a set has, where cpuid shows them, and that xgetbv shows where the system keeps the set's
// registers.
struct Needs {
    const char* isa;
    uint32_t ecx_of_1, ecx_of_80000001, ebx_of_7, enabled;
};

constexpr uint32_t bits(std::initializer_list<int> places)
{
    uint32_t mask = 0;
    for (const int place : places) mask |= 1u << place;
    return mask;
}

// x86-64-v3: SSE3, SSSE3, FMA, CMPXCHG16B, SSE4.1, SSE4.2, MOVBE, POPCNT, OSXSAVE, AVX, F16C; LAHF, LZCNT; BMI1, AVX2,
// BMI2; the registers of SSE and AVX. x86-64-v4: AVX-512 F, DQ, CD, BW, VL, and its masks and registers, too.
constexpr uint32_t ecx_of_v3 = bits({0, 9, 12, 13, 19, 20, 22, 23, 27, 28, 29});
constexpr Needs known[] = {
    {"avx2", ecx_of_v3, bits({0, 5}), bits({3, 5, 8}), bits({1, 2})},
    {"avx512", ecx_of_v3, bits({0, 5}), bits({3, 5, 8, 16, 17, 28, 30, 31}), bits({1, 2, 5, 6, 7})},
};
constexpr uint32_t may_ask_enabled = bits({27}); // OSXSAVE: xgetbv is there

class Chooser {
public:
    explicit Chooser(llvm::Module& to)
        : function(llvm::Function::Create(llvm::FunctionType::get(llvm::Type::getVoidTy(to.getContext()), false),
                                          llvm::GlobalValue::InternalLinkage, "haptel_choose_set", to))
        , b(block())
        , end(block())
    {
        function->addFnAttr(llvm::Attribute::NoUnwind);
        llvm::appendToGlobalCtors(to, function, 101); // the first of those that are not the C library's own
    }

    void ask_processor()
    {
        ecx_of_1 = cpuid(1, ecx);
        ecx_of_80000001 = cpuid(0x80000001, ecx);
        ebx_of_7 = cpuid(7, ebx);
        // An old processor answers a question that it does not know with anything.
        Value* const answers = b.CreateAnd(b.CreateICmpUGE(cpuid(0, eax), b.getInt32(7)),
                                           b.CreateICmpUGE(cpuid(0x80000000, eax), b.getInt32(0x80000001)));
        go_on_if(b.CreateAnd(answers, has(ecx_of_1, may_ask_enabled)), end);
        auto* const type =
            llvm::FunctionType::get(llvm::StructType::get(b.getInt32Ty(), b.getInt32Ty()), {b.getInt32Ty()}, false);
        auto* const xgetbv = llvm::InlineAsm::get(type, "xgetbv", "={ax},={dx},{cx},~{dirflag},~{fpsr},~{flags}", true);
        enabled = b.CreateExtractValue(b.CreateCall(xgetbv, {b.getInt32(0)}), 0);
    }

    void use(const SetOfEntries& set, const std::vector<llvm::GlobalVariable*>& tables)
    {
        const Needs& needs = *std::ranges::find_if(known, [&](const Needs& one) { return set.isa == one.isa; });
        Value* const fits = b.CreateAnd({has(ecx_of_1, needs.ecx_of_1), has(ecx_of_80000001, needs.ecx_of_80000001),
                                         has(ebx_of_7, needs.ebx_of_7), has(enabled, needs.enabled)});
        go_on_if(fits, end); // a larger set has all that this one has
        constexpr size_t places[] = {offsetof(haptel_texture, height), offsetof(haptel_texture, height_gradient),
                                     offsetof(haptel_texture, height_batch),
                                     offsetof(haptel_texture, height_gradient_batch)};
        for (size_t i = 0; i < tables.size(); ++i)
            for (size_t k = 0; k < std::size(places); ++k)
                if (llvm::Function* const entry = set.entries[i][k])
                    b.CreateStore(entry, b.CreateConstInBoundsGEP1_64(b.getInt8Ty(), tables[i], places[k]));
    }

    void finish()
    {
        b.CreateBr(end);
        b.SetInsertPoint(end);
        b.CreateRetVoid();
    }

private:
    enum Register : unsigned { eax, ebx, ecx };

    llvm::Function* const function;
    llvm::IRBuilder<> b;
    llvm::BasicBlock* const end;
    Value *ecx_of_1 = nullptr, *ecx_of_80000001 = nullptr, *ebx_of_7 = nullptr, *enabled = nullptr;

    llvm::BasicBlock* block() const { return llvm::BasicBlock::Create(function->getContext(), "", function); }

    Value* cpuid(uint32_t leaf, Register wanted)
    {
        llvm::Type* const word = b.getInt32Ty();
        auto* const type = llvm::FunctionType::get(llvm::StructType::get(word, word, word, word), {word, word}, false);
        auto* const code =
            llvm::InlineAsm::get(type, "cpuid", "={ax},={bx},={cx},={dx},0,2,~{dirflag},~{fpsr},~{flags}", true);
        return b.CreateExtractValue(b.CreateCall(code, {b.getInt32(leaf), b.getInt32(0)}), wanted);
    }
    Value* has(Value* found, uint32_t mask)
    {
        return b.CreateICmpEQ(b.CreateAnd(found, b.getInt32(mask)), b.getInt32(mask));
    }
    void go_on_if(Value* condition, llvm::BasicBlock* otherwise)
    {
        llvm::BasicBlock* const next = block();
        b.CreateCondBr(condition, next, otherwise);
        b.SetInsertPoint(next);
    }
};

} // namespace

void choose_at_load(llvm::Module& module, const std::vector<llvm::GlobalVariable*>& tables,
                    const std::vector<SetOfEntries>& sets)
{
    Chooser chooser(module);
    chooser.ask_processor();
    for (const SetOfEntries& set : sets) chooser.use(set, tables);
    chooser.finish();
}

} // namespace haptel::jit
