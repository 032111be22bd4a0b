#include "jit/codegen/codegen_turn.h"

#include "lang/math/turn_polynomials.h"

#include <span>

namespace haptel::jit {

namespace {

using llvm::Value;

class Turn {
public:
    Turn(llvm::IRBuilder<>& to, Value* whole_way, llvm::Type* element, bool may_fuse)
        : builder(to), is_single(element->isFloatTy()), fuses(may_fuse && is_single)
    {
        type = whole_way->getType()->getWithNewType(element);
        way = builder.CreateFPCast(whole_way, type);
        Value* folded = builder.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, way);
        is_behind_quarter = builder.CreateFCmpOGT(folded, real(0.25));
        folded = builder.CreateSelect(is_behind_quarter, builder.CreateFSub(real(0.5), folded), folded);
        is_near_quarter = builder.CreateFCmpOGT(folded, real(0.125));
        to_quarter = builder.CreateSelect(is_near_quarter, builder.CreateFSub(real(0.25), folded), folded);
        square = builder.CreateFMul(to_quarter, to_quarter);
    }
    Value* sine()
    {
        Value* size = builder.CreateSelect(is_near_quarter, cosine_within_eighth(), sine_within_eighth());
        return builder.CreateBinaryIntrinsic(llvm::Intrinsic::copysign, size, way);
    }
    Value* cosine()
    {
        Value* size = builder.CreateSelect(is_near_quarter, sine_within_eighth(), cosine_within_eighth());
        return builder.CreateSelect(is_behind_quarter, builder.CreateFNeg(size), size);
    }

private:
    llvm::IRBuilder<>& builder;
    const bool is_single, fuses;
    llvm::Type* type;
    Value *way, *is_behind_quarter, *is_near_quarter, *to_quarter, *square;

    Value* real(double value) { return llvm::ConstantFP::get(type, value); }
    Value* polynomial(std::span<const double> coefficients)
    {
        Value* sum = real(coefficients.back());
        for (size_t i = coefficients.size() - 1; i-- > 0;) sum = times_and(sum, square, real(coefficients[i]));
        return sum;
    }
    Value* times_and(Value* a, Value* b, Value* c)
    {
        return fuses ? builder.CreateIntrinsic(llvm::Intrinsic::fma, {type}, {a, b, c})
                     : builder.CreateFAdd(builder.CreateFMul(a, b), c);
    }
    Value* sine_within_eighth()
    {
        using namespace ir::turn;
        return builder.CreateFMul(to_quarter, is_single ? polynomial(sine_f32) : polynomial(sine_f64));
    }
    Value* cosine_within_eighth()
    {
        using namespace ir::turn;
        return times_and(square, is_single ? polynomial(cosine_f32) : polynomial(cosine_f64), real(1));
    }
};

} // namespace

llvm::Value* sine_of_turns(llvm::IRBuilder<>& builder, llvm::Value* way, llvm::Type* result, bool fuses)
{
    return Turn(builder, way, result, fuses).sine();
}

llvm::Value* cosine_of_turns(llvm::IRBuilder<>& builder, llvm::Value* way, llvm::Type* result, bool fuses)
{
    return Turn(builder, way, result, fuses).cosine();
}

} // namespace haptel::jit
