// One IR operation as LLVM instructions, all of them in one long page.
#include "jit/codegen/codegen.h"
#include "jit/codegen/codegen_math.h"
#include "lang/math/elementary_number.h"
#include "lang/math/spline.h"

#include <cmath>
#include <cstring>
#include <string>

namespace haptel::jit {

namespace {

using llvm::Value;

template <typename Function>
void* address(Function* function)
{
    return reinterpret_cast<void*>(function);
}

double spline_of_doubles(const haptel_image* image, double x, double y, uint32_t orders)
{
    return ir::spline(image, x, y, orders);
}

// Operands, in the order of ops.def, are a, b, c, d.
class Emitter {
public:
    Emitter(llvm::IRBuilder<>& to, llvm::ArrayRef<Value*> from, llvm::Type* scalar_real)
        : builder(to)
        , operands(from)
        , scalar(scalar_real)
        , vector(llvm::dyn_cast<llvm::FixedVectorType>(from.back()->getType()))
    {
    }

    Value* emit(ir::Op op, llvm::Type* result, bool fuses);

private:
    llvm::IRBuilder<>& builder;
    const llvm::ArrayRef<Value*> operands;
    llvm::Type* const scalar;                  // double or float
    const llvm::FixedVectorType* const vector; // of the operands; null: they are scalars

    Value* a() const { return operands[0]; }
    Value* b() const { return operands[1]; }

    llvm::Type* as(llvm::Type* element)
    {
        return vector ? llvm::FixedVectorType::get(element, vector->getNumElements()) : element;
    }
    bool is_single() const { return scalar->isFloatTy(); }
    llvm::Type* reals() { return as(scalar); }
    llvm::Type* words() { return as(builder.getInt32Ty()); }
    Value* real(double value) { return llvm::ConstantFP::get(reals(), value); }
    Value* word(uint32_t value) { return llvm::ConstantInt::get(words(), value); }
    Value* intrinsic(llvm::Intrinsic::ID id, Value* x) { return builder.CreateUnaryIntrinsic(id, x); }
    Value* intrinsic(llvm::Intrinsic::ID id, Value* x, Value* y) { return builder.CreateBinaryIntrinsic(id, x, y); }
    Value* absolute(Value* x) { return intrinsic(llvm::Intrinsic::fabs, x); }
    Value* floor(Value* x) { return intrinsic(llvm::Intrinsic::floor, x); }
    Value* choose(Value* condition, Value* x, Value* y) { return builder.CreateSelect(condition, x, y); }
    Value* way_to_whole_turn() { return builder.CreateFSub(a(), intrinsic(llvm::Intrinsic::roundeven, a())); }
    Value* shift_count() { return builder.CreateAnd(b(), word(31)); }

    // Lane by lane, in f64. Total, and reads what no one writes while code runs.
    Value* read_image(const char* name, llvm::Type* result)
    {
        std::vector<Value*> arguments;
        std::vector<llvm::Type*> types;
        for (Value* argument : operands) {
            const bool is_float = argument->getType()->getScalarType()->isFloatTy();
            arguments.push_back(is_float ? builder.CreateFPExt(argument, as(builder.getDoubleTy())) : argument);
            types.push_back(arguments.back()->getType()->getScalarType());
        }
        llvm::Module* module = builder.GetInsertBlock()->getModule();
        auto* type = llvm::FunctionType::get(result, types, false);
        auto* function = llvm::cast<llvm::Function>(module->getOrInsertFunction(name, type).getCallee());
        function->setDoesNotThrow();
        function->setMemoryEffects(llvm::MemoryEffects::readOnly());
        function->setWillReturn();
        Value* results = llvm::PoisonValue::get(as(result));
        if (!vector) results = builder.CreateCall(function, arguments);
        for (uint64_t lane = 0; vector && lane < vector->getNumElements(); ++lane) {
            std::vector<Value*> scalars;
            for (Value* argument : arguments)
                scalars.push_back(argument->getType()->isVectorTy() ? builder.CreateExtractElement(argument, lane)
                                                                    : argument);
            results = builder.CreateInsertElement(results, builder.CreateCall(function, scalars), lane);
        }
        return result->isDoubleTy() && is_single() ? builder.CreateFPTrunc(results, reals()) : results;
    }

    // Not llvm.minimum: the pass InstSimplify, before LLVM 22, crashes on min(min(x, y), fma(x, y, z)) of intrinsics.
    // With a constant this is one instruction. A NaN goes through as it is; of zeros min takes the bits of either, max
    // of both.
    Value* lesser(Value* x, Value* y, bool greater = false)
    {
        if (llvm::isa<llvm::Constant>(y)) std::swap(x, y);
        Value* chosen =
            choose(greater ? builder.CreateFCmpOGT(x, y) : builder.CreateFCmpOLT(x, y), x, y); // y if one is NaN
        const auto* constant = llvm::dyn_cast<llvm::Constant>(x);
        const auto* number = llvm::dyn_cast_or_null<llvm::ConstantFP>(
            constant && vector ? constant->getSplatValue() : static_cast<const llvm::Value*>(constant));
        if (!number || number->isZero()) {
            llvm::Type* const bits = as(builder.getIntNTy(scalar->getScalarSizeInBits()));
            Value *first = builder.CreateBitCast(x, bits), *second = builder.CreateBitCast(y, bits);
            Value* both = greater ? builder.CreateAnd(first, second) : builder.CreateOr(first, second);
            chosen = choose(builder.CreateFCmpOEQ(x, y), builder.CreateBitCast(both, x->getType()), chosen);
        }
        if (number && !number->isNaN()) return chosen;
        return choose(builder.CreateFCmpUNO(x, x), x, chosen);
    }

    Value* sign()
    {
        Value* negative = choose(builder.CreateFCmpOLT(a(), real(0)), real(-1), a());
        return choose(builder.CreateFCmpOGT(a(), real(0)), real(1), negative);
    }

    Value* length()
    {
        Value* largest = absolute(operands[0]);
        for (Value* x : operands.drop_front()) largest = lesser(largest, absolute(x), true);
        const double limit = is_single() ? 0x1p60 : 0x1p500, factor = is_single() ? 0x1p80 : 0x1p600;
        Value* huge = builder.CreateFCmpOGT(largest, real(limit));
        Value* tiny = builder.CreateFCmpOLT(largest, real(1 / limit));
        Value* scale = choose(huge, real(1 / factor), choose(tiny, real(factor), real(1)));
        Value* unscale = choose(huge, real(factor), choose(tiny, real(1 / factor), real(1)));
        Value* sum = nullptr;
        for (Value* x : operands) {
            Value* scaled = builder.CreateFMul(x, scale);
            Value* square = builder.CreateFMul(scaled, scaled);
            sum = sum ? builder.CreateFAdd(sum, square) : square;
        }
        return builder.CreateFMul(intrinsic(llvm::Intrinsic::sqrt, sum), unscale);
    }

    // The processor's division traps at 0 and at INT_MIN / -1: it gets a divisor of 1 there.
    Value* divide(bool is_signed, bool want_remainder)
    {
        Value* by_zero = builder.CreateICmpEQ(b(), word(0));
        Value* by_minus_one = is_signed ? builder.CreateICmpEQ(b(), word(~0u)) : nullptr;
        Value* divisor = choose(is_signed ? builder.CreateOr(by_zero, by_minus_one) : by_zero, word(1), b());
        if (want_remainder) // 0 for divisor 1
            return is_signed ? builder.CreateSRem(a(), divisor) : builder.CreateURem(a(), divisor);
        Value* quotient = is_signed ? choose(by_minus_one, builder.CreateNeg(a()), builder.CreateSDiv(a(), divisor))
                                    : builder.CreateUDiv(a(), divisor);
        return choose(by_zero, word(0), quotient);
    }

    // To a whole number, toward zero; NaN to 0, what does not fit to the nearest that does. LLVM's own takes a vector
    // apart.
    Value* saturate(bool is_signed)
    {
        namespace in = llvm::Intrinsic;
        if (!vector)
            return builder.CreateIntrinsic(is_signed ? in::fptosi_sat : in::fptoui_sat, {words(), reals()}, {a()});
        const uint32_t most = is_signed ? INT32_MAX : UINT32_MAX;
        // The greatest real whose whole part fits, and the first that does not.
        const double beyond = is_signed ? 0x1p31 : 0x1p32, fits = beyond - (is_single() ? (is_signed ? 128 : 256) : 1);
        const double least = is_signed ? -0x1p31 : 0;
        Value* x = choose(builder.CreateFCmpOGT(a(), real(least)), a(), real(least));
        x = choose(builder.CreateFCmpOLT(x, real(fits)), x, real(fits));
        Value* whole = is_signed ? builder.CreateFPToSI(x, words()) : builder.CreateFPToUI(x, words());
        if (is_single()) whole = choose(builder.CreateFCmpOGE(a(), real(beyond)), word(most), whole);
        return choose(builder.CreateFCmpUNO(a(), a()), word(0), whole);
    }
};

Value* Emitter::emit(ir::Op op, llvm::Type* result, bool fuses)
{
    using ir::Op;
    namespace in = llvm::Intrinsic;
    switch (op) {
    case Op::add: return builder.CreateFAdd(a(), b());
    case Op::sub: return builder.CreateFSub(a(), b());
    case Op::mul: return builder.CreateFMul(a(), b());
    case Op::div: return builder.CreateFDiv(a(), b());
    case Op::neg: return builder.CreateFNeg(a());
    case Op::fma: return builder.CreateIntrinsic(in::fma, {reals()}, {a(), b(), operands[2]});
    case Op::min: return lesser(a(), b());
    case Op::max: return lesser(a(), b(), true);
    case Op::abs: return absolute(a());
    case Op::sign: return sign();
    case Op::floor: return floor(a());
    case Op::ceil: return intrinsic(in::ceil, a());
    case Op::trunc: return intrinsic(in::trunc, a());
    case Op::round: return intrinsic(in::roundeven, a());
    case Op::fract: return builder.CreateFSub(a(), floor(a()));
    case Op::mod: return builder.CreateFSub(a(), builder.CreateFMul(b(), floor(builder.CreateFDiv(a(), b()))));
    case Op::sqrt: return intrinsic(in::sqrt, a());
    case Op::length2:
    case Op::length3:
    case Op::length4: return length();
    case Op::sinturn:
    case Op::costurn: return emit_turn(builder, op, way_to_whole_turn(), result, fuses);
#define ELEMENTARY(name, ...) case Op::name:
#include "lang/ir/ops.def"
        return call_elementary(builder, op, operands, result);
    case Op::lt: return builder.CreateFCmpOLT(a(), b());
    case Op::le: return builder.CreateFCmpOLE(a(), b());
    case Op::eq: return builder.CreateFCmpOEQ(a(), b());
    case Op::is_finite: return builder.CreateFCmpOLT(absolute(a()), real(HUGE_VAL));
    case Op::ilt: return builder.CreateICmpSLT(a(), b());
    case Op::ile: return builder.CreateICmpSLE(a(), b());
    case Op::ieq: return builder.CreateICmpEQ(a(), b());
    case Op::ult: return builder.CreateICmpULT(a(), b());
    case Op::ule: return builder.CreateICmpULE(a(), b());
    case Op::ueq: return builder.CreateICmpEQ(a(), b());
    case Op::lnot: return builder.CreateNot(a());
    case Op::select: return choose(a(), b(), operands[2]);
    case Op::iadd: return builder.CreateAdd(a(), b());
    case Op::isub: return builder.CreateSub(a(), b());
    case Op::imul: return builder.CreateMul(a(), b());
    case Op::idiv: return divide(true, false);
    case Op::irem: return divide(true, true);
    case Op::iand:
    case Op::land: return builder.CreateAnd(a(), b());
    case Op::ior:
    case Op::lor: return builder.CreateOr(a(), b());
    case Op::ixor:
    case Op::lxor: return builder.CreateXor(a(), b());
    case Op::ishl: return builder.CreateShl(a(), shift_count());
    case Op::ishr: return builder.CreateAShr(a(), shift_count());
    case Op::imin: return intrinsic(in::smin, a(), b());
    case Op::imax: return intrinsic(in::smax, a(), b());
    case Op::udiv: return divide(false, false);
    case Op::urem: return divide(false, true);
    case Op::ushr: return builder.CreateLShr(a(), shift_count());
    case Op::umin: return intrinsic(in::umin, a(), b());
    case Op::umax: return intrinsic(in::umax, a(), b());
    case Op::i_to_r: return builder.CreateSIToFP(a(), reals());
    case Op::u_to_r: return builder.CreateUIToFP(a(), reals());
    case Op::r_to_i: return saturate(true);
    case Op::r_to_u: return saturate(false);
    case Op::spline: return read_image("haptel_spline", builder.getDoubleTy());
    case Op::image_channel: return read_image("haptel_image_channel", builder.getPtrTy());
    case Op::image_coarser: return read_image("haptel_image_coarser", builder.getPtrTy());
    case Op::image_width: return read_image("haptel_image_width", builder.getInt32Ty());
    case Op::image_height: return read_image("haptel_image_height", builder.getInt32Ty());
    case Op::i_as_u:
    case Op::u_as_i:
    case Op::detach: return a();
    case Op::b_to_i: return builder.CreateZExt(a(), words());
    }
    return nullptr;
}

} // namespace

llvm::Value* emit_operation(llvm::IRBuilder<>& builder, ir::Op op, llvm::ArrayRef<llvm::Value*> operands,
                            llvm::Type* real, llvm::Type* result, bool fuses)
{
    return Emitter(builder, operands, real).emit(op, result, fuses);
}

std::span<const LibraryFunction> code_library()
{
    static const LibraryFunction functions[] = {
        {"haptel_reduce_angles", address(&ir::elementary::reduce_huge_angles)},
        {"haptel_spline", address(&spline_of_doubles)},
        {"haptel_image_channel", address(&ir::image_channel)},
        {"haptel_image_coarser", address(&ir::image_coarser)},
        {"haptel_image_width", address(&ir::image_width)},
        {"haptel_image_height", address(&ir::image_height)},
        // What the instruction selector calls by itself where the processor has no such instruction. All are exact or
        // correctly rounded.
        {"floor", address<double(double)>(std::floor)},
        {"ceil", address<double(double)>(std::ceil)},
        {"trunc", address<double(double)>(std::trunc)},
        {"roundeven", address<double(double)>(std::nearbyint)},
        {"fma", address<double(double, double, double)>(std::fma)},
        {"floorf", address<float(float)>(std::floor)},
        {"ceilf", address<float(float)>(std::ceil)},
        {"truncf", address<float(float)>(std::trunc)},
        {"roundevenf", address<float(float)>(std::nearbyint)},
        {"fmaf", address<float(float, float, float)>(std::fma)},
        {"memcpy", address(&std::memcpy)},
        {"memset", address(&std::memset)},
    };
    return functions;
}

} // namespace haptel::jit
