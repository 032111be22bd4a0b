// A number of lang/ir/elementary_*.h that is code: each step appends the instruction that does it, for one point or in
// every lane of a vector.
#pragma once

#include "jit/codegen/llvm.h"
#include "lang/math/elementary_number.h"

namespace haptel::jit {

struct CodeTruth {
    llvm::IRBuilder<>* builder;
    llvm::Value* value;
};

// A word for each number, of its width.
class CodeWord {
public:
    CodeWord(llvm::IRBuilder<>& to, llvm::Value* made) : builder(&to), value(made) {}

    friend CodeWord operator+(CodeWord a, uint64_t b) { return a.held(a.builder->CreateAdd(a.value, a.word(b))); }
    friend CodeWord operator&(CodeWord a, uint64_t b) { return a.held(a.builder->CreateAnd(a.value, a.word(b))); }
    friend CodeWord operator|(CodeWord a, uint64_t b) { return a.held(a.builder->CreateOr(a.value, a.word(b))); }
    friend CodeWord operator^(CodeWord a, CodeWord b) { return a.held(a.builder->CreateXor(a.value, b.value)); }
    friend CodeWord operator<<(CodeWord a, int count)
    {
        return a.held(a.builder->CreateShl(a.value, a.word(static_cast<uint64_t>(count))));
    }
    friend CodeWord operator>>(CodeWord a, int count)
    {
        return a.held(a.builder->CreateLShr(a.value, a.word(static_cast<uint64_t>(count))));
    }
    friend CodeTruth is_set(CodeWord a) { return {a.builder, a.builder->CreateICmpNE(a.value, a.word(0))}; }
    llvm::Value* code() const { return value; }

private:
    llvm::IRBuilder<>* builder;
    llvm::Value* value;

    CodeWord held(llvm::Value* made) const { return {*builder, made}; }
    llvm::Value* word(uint64_t bits) const { return llvm::ConstantInt::get(value->getType(), bits); }
};

template <typename F>
class Code {
public:
    using Float = F;
    static constexpr bool is_single = sizeof(F) == sizeof(float);

    Code(llvm::IRBuilder<>& to, llvm::Value* made) : builder(&to), value(made) {}
    Code(double constant_number) : number(constant_number) {} // becomes code beside one that is

    friend Code operator+(Code a, Code b) { return made(a, b, &llvm::IRBuilder<>::CreateFAdd); }
    friend Code operator-(Code a, Code b) { return made(a, b, &llvm::IRBuilder<>::CreateFSub); }
    friend Code operator*(Code a, Code b) { return made(a, b, &llvm::IRBuilder<>::CreateFMul); }
    friend Code operator/(Code a, Code b) { return made(a, b, &llvm::IRBuilder<>::CreateFDiv); }
    friend Code operator-(Code a) { return a.held(a.builder->CreateFNeg(a.value)); }
    friend CodeTruth operator<(Code a, Code b) { return compared(a, b, llvm::CmpInst::FCMP_OLT); }
    friend CodeTruth operator>(Code a, Code b) { return compared(a, b, llvm::CmpInst::FCMP_OGT); }
    friend CodeTruth operator==(Code a, Code b) { return compared(a, b, llvm::CmpInst::FCMP_OEQ); }

    friend Code abs(Code a) { return a.held(a.builder->CreateUnaryIntrinsic(llvm::Intrinsic::fabs, a.value)); }
    friend Code sqrt(Code a) { return a.held(a.builder->CreateUnaryIntrinsic(llvm::Intrinsic::sqrt, a.value)); }
    friend Code select(CodeTruth condition, Code a, Code b)
    {
        return a.held(a.builder->CreateSelect(condition.value, a.value, b.value));
    }
    friend Code constant(Code like, double number) { return like.held(llvm::ConstantFP::get(like.type(), number)); }

    friend CodeWord bits(Code a)
    {
        llvm::Type* const words = a.type()->getWithNewType(a.builder->getIntNTy(ir::elementary::Format<F>::width));
        return {*a.builder, a.builder->CreateBitCast(a.value, words)};
    }
    friend Code with_bits(Code like, CodeWord bits)
    {
        return like.held(like.builder->CreateBitCast(bits.code(), like.type()));
    }

    friend Code<float> narrow(Code a) { return {*a.builder, a.builder->CreateFPTrunc(a.value, a.as_float())}; }
    friend Code<double> widen(Code a) { return {*a.builder, a.builder->CreateFPExt(a.value, a.as_double())}; }

    llvm::IRBuilder<>& at() const { return *builder; }
    llvm::Value* code() const { return value; }

private:
    llvm::IRBuilder<>* builder = nullptr; // null: a constant on its way
    llvm::Value* value = nullptr;
    double number = 0;

    llvm::Type* type() const { return value->getType(); }
    llvm::Type* as_float() const { return type()->getWithNewType(builder->getFloatTy()); }
    llvm::Type* as_double() const { return type()->getWithNewType(builder->getDoubleTy()); }
    Code held(llvm::Value* result) const { return {*builder, result}; }
    static void complete(Code& a, Code& b)
    {
        if (!a.value) a = constant(b, a.number);
        if (!b.value) b = constant(a, b.number);
    }
    template <typename Create>
    static Code made(Code a, Code b, Create create)
    {
        complete(a, b);
        return a.held((a.builder->*create)(a.value, b.value, "", nullptr));
    }
    static CodeTruth compared(Code a, Code b, llvm::CmpInst::Predicate predicate)
    {
        complete(a, b);
        return {a.builder, a.builder->CreateFCmp(predicate, a.value, b.value)};
    }
};

// The rare branch: where any lane needs it all are reduced, and those that do not keep what they had.
void reduce_where(CodeTruth condition, Code<double> a, ir::elementary::Angle<Code<double>>& angle);

} // namespace haptel::jit
