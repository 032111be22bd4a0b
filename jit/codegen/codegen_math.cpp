#include "jit/codegen/codegen_math.h"

#include "lang/ir/elementary_functions.h"
#include "lang/ir/op_info.h"
#include "lang/math/elementary_constants.h"
#include "lang/math/elementary_number.h"

#include <llvm/IR/MDBuilder.h>
#include <span>
#include <string>

namespace haptel::jit {

namespace {

using llvm::Value;

uint32_t lanes_of(llvm::Type* type)
{
    const auto* vector = llvm::dyn_cast<llvm::FixedVectorType>(type);
    return vector ? vector->getNumElements() : 1;
}

// ---- a number of lang/math/elementary_*.h that is code: each step appends the instruction that does it, for one point
// or in every lane of a vector

struct CodeTruth {
    llvm::IRBuilder<>* builder;
    Value* value;
};

// A word for each number, of its width.
class CodeWord {
public:
    CodeWord(llvm::IRBuilder<>& to, Value* made) : builder(&to), value(made) {}

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
    Value* code() const { return value; }

private:
    llvm::IRBuilder<>* builder;
    Value* value;

    CodeWord held(Value* made) const { return {*builder, made}; }
    Value* word(uint64_t bits) const { return llvm::ConstantInt::get(value->getType(), bits); }
};

template <typename F>
class Code {
public:
    using Float = F;
    static constexpr bool is_single = sizeof(F) == sizeof(float);

    Code(llvm::IRBuilder<>& to, Value* made) : builder(&to), value(made) {}
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
    Value* code() const { return value; }

private:
    llvm::IRBuilder<>* builder = nullptr; // null: a constant on its way
    Value* value = nullptr;
    double number = 0;

    llvm::Type* type() const { return value->getType(); }
    llvm::Type* as_float() const { return type()->getWithNewType(builder->getFloatTy()); }
    llvm::Type* as_double() const { return type()->getWithNewType(builder->getDoubleTy()); }
    Code held(Value* result) const { return {*builder, result}; }
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

// The rare branch: where any lane needs it all are reduced, and those that do not keep what they had. As a call through
// memory: it is a hundred times as long as the rest, whatever the lanes.
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

// ---- functions

constexpr llvm::StringLiteral prefix = "haptel_e.";

struct ElementaryForm {
    ir::Op op{};
    bool is_single = false; // the operands
    bool narrows = false;   // an angle in f64 to f32
    uint32_t lanes = 1;
};

llvm::Function& declare(llvm::Module& module, const ElementaryForm& form)
{
    const std::string symbol = prefix.str() + std::string(ir::op_info(form.op).name) +
                               (form.is_single ? ".f32"
                                : form.narrows ? ".f32.f64"
                                               : ".f64") +
                               "x" + std::to_string(form.lanes);
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

// Of a function that was declared so and has no body; nothing of any other.
std::optional<ElementaryForm> form_of(const llvm::Function& function)
{
    llvm::StringRef name = function.getName();
    if (!function.isDeclaration() || !name.consume_front(prefix)) return {};
    llvm::Type* const operand = function.getArg(0)->getType();
    const bool is_single = operand->getScalarType()->isFloatTy();
    const bool narrows = !is_single && function.getReturnType()->getScalarType()->isFloatTy();
    return ElementaryForm{*ir::op_named(std::string_view(name.split('.').first)), is_single, narrows,
                          lanes_of(operand)};
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

template <typename F>
Value* turn(llvm::IRBuilder<>& builder, bool is_sine, Value* whole_way, bool fuses)
{
    using R = Code<F>;
    llvm::Type* const element = R::is_single ? builder.getFloatTy() : builder.getDoubleTy();
    const R way(builder, builder.CreateFPCast(whole_way, whole_way->getType()->getWithNewType(element)));
    const R distance = abs(way);
    const CodeTruth is_behind_quarter = distance > R(0.25);
    const R folded = select(is_behind_quarter, R(0.5) - distance, distance);
    const CodeTruth is_near_quarter = folded > R(0.125);
    const R to_quarter = select(is_near_quarter, R(0.25) - folded, folded);
    const R square = to_quarter * to_quarter;
    const auto times_and = [&](R a, R b, double number) {
        const R c = constant(a, number);
        if (!fuses) return a * b + c;
        return R(builder,
                 builder.CreateIntrinsic(llvm::Intrinsic::fma, {a.code()->getType()}, {a.code(), b.code(), c.code()}));
    };
    const auto polynomial = [&](std::span<const double> coefficients) {
        R sum = constant(square, coefficients.back());
        for (size_t i = coefficients.size() - 1; i-- > 0;) sum = times_and(sum, square, coefficients[i]);
        return sum;
    };
    using namespace ir::turn;
    const R sine = to_quarter * (R::is_single ? polynomial(sine_f32) : polynomial(sine_f64));
    const R cosine = times_and(square, R::is_single ? polynomial(cosine_f32) : polynomial(cosine_f64), 1);
    if (is_sine)
        return builder.CreateBinaryIntrinsic(llvm::Intrinsic::copysign, select(is_near_quarter, cosine, sine).code(),
                                             way.code());
    const R size = select(is_near_quarter, sine, cosine);
    return select(is_behind_quarter, -size, size).code();
}

} // namespace

Value* call_elementary(llvm::IRBuilder<>& builder, ir::Op op, llvm::ArrayRef<Value*> operands, llvm::Type* result)
{
    const bool is_single = operands[0]->getType()->getScalarType()->isFloatTy();
    const bool narrows = ir::takes_angle(op) && result->isFloatTy() && !is_single;
    llvm::Function& function =
        declare(*builder.GetInsertBlock()->getModule(), {op, is_single, narrows, lanes_of(operands[0]->getType())});
    llvm::CallInst* call = builder.CreateCall(&function, operands);
    call->setCallingConv(llvm::CallingConv::Fast);
    return call;
}

Value* emit_turn(llvm::IRBuilder<>& builder, ir::Op op, Value* way, llvm::Type* result, bool fuses)
{
    const bool is_sine = op == ir::Op::sinturn;
    return result->isFloatTy() ? turn<float>(builder, is_sine, way, fuses) : turn<double>(builder, is_sine, way, false);
}

FunctionsApart elementary_calls(const llvm::Module& module)
{
    FunctionsApart found;
    for (const llvm::Function& function : module)
        if (const std::optional<ElementaryForm> form = form_of(function))
            found[function.getName().str()] = [form = *form](llvm::Module& alone, bool) {
                write_body(declare(alone, form), form);
            };
    return found;
}

void write_elementary(llvm::Module& module)
{
    for (llvm::Function& function : module)
        if (const std::optional<ElementaryForm> form = form_of(function)) {
            function.setLinkage(llvm::GlobalValue::InternalLinkage);
            if (form->lanes > 1) function.addFnAttr(llvm::Attribute::NoInline); // it fills the registers by itself
            write_body(function, *form);
        }
}

} // namespace haptel::jit
