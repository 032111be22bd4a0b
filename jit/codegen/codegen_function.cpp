#include "jit/codegen/codegen_function.h"

#include "jit/codegen/codegen_operation.h"
#include "jit/codegen/codegen_table.h"
#include "lang/abi/abi.h"

#include <algorithm>
#include <cstddef>

namespace haptel::jit {

namespace {

using llvm::Value;

// ir::Input counts the doubles of haptel_point, then those of haptel_block_head.
constexpr size_t point_inputs = static_cast<size_t>(ir::Input::center_x);
static_assert(sizeof(haptel_point) == point_inputs * sizeof(double));
static_assert(sizeof(haptel_points) == point_inputs * sizeof(double*));
static_assert(sizeof(haptel_block_head) == (ir::input_count - point_inputs) * sizeof(double));
static_assert(offsetof(haptel_point, time_s) == static_cast<size_t>(ir::Input::time) * sizeof(double));
static_assert(offsetof(haptel_points, time_s) == static_cast<size_t>(ir::Input::time) * sizeof(double*));
static_assert(offsetof(haptel_point, uv_dp) == static_cast<size_t>(ir::Input::uv_dp_00) * sizeof(double));
static_assert(offsetof(haptel_points, uv_dp) == static_cast<size_t>(ir::Input::uv_dp_00) * sizeof(double*));
static_assert(offsetof(haptel_block_head, footprint_m) ==
              (static_cast<size_t>(ir::Input::footprint) - point_inputs) * sizeof(double));

} // namespace

FunctionEmitter::FunctionEmitter(ModuleEmitter& owner, const ir::Function& from, llvm::Function& to,
                                 const ValueForms& value_forms, const EntryArguments& entry)
    : module(owner)
    , source(from)
    , target(to)
    , forms(value_forms)
    , arguments(entry)
    , builder(&to.back())
    , values(from.value_types.size())
    , products(from.value_types.size())
{
}

Value* FunctionEmitter::value(ir::Value used)
{
    Value* const held = values[used.index];
    return held || forms.is_needed(used) ? held : llvm::PoisonValue::get(type(used));
}

bool FunctionEmitter::is_needed(const ir::Instruction& made) const
{
    return std::any_of(made.results.begin(), made.results.end(),
                       [&](ir::Value result) { return forms.is_needed(result); });
}

Value* FunctionEmitter::value(ir::Value used, Form wanted)
{
    Value* held = value(used);
    if (source.type(used) == ir::Type::image) return held;
    if (source.type(used) == ir::Type::real) held = rounded(held, wanted.is_single);
    return wanted.in_lanes && !forms[used].in_lanes ? builder.CreateVectorSplat(module.lanes, held) : held;
}

Value* FunctionEmitter::rounded(Value* real, bool to_single)
{
    llvm::Type* from = real->getType();
    if (from->getScalarType()->isFloatTy() == to_single) return real;
    llvm::Type* to = from->getWithNewType(to_single ? builder.getFloatTy() : builder.getDoubleTy());
    return to_single ? builder.CreateFPTrunc(real, to) : builder.CreateFPExt(real, to);
}

llvm::BasicBlock* FunctionEmitter::new_block(const char* name)
{
    return llvm::BasicBlock::Create(target.getContext(), name, &target);
}

Value* FunctionEmitter::at_offset(Value* base, size_t offset)
{
    return builder.CreateConstInBoundsGEP1_64(builder.getInt8Ty(), base, offset);
}

std::vector<Value*> FunctionEmitter::block(const ir::Block& from, const std::vector<Form>& yield_forms)
{
    for (const ir::Instruction& instruction : from.instructions)
        if (!done.contains(&instruction)) emit(instruction);
    std::vector<Value*> yields;
    for (size_t i = 0; i < from.yields.size(); ++i) yields.push_back(value(from.yields[i], yield_forms[i]));
    return yields;
}

void FunctionEmitter::emit(const ir::Instruction& made)
{
    if (is_needed(made)) std::visit([&](const auto& kind) { emit(made, kind); }, made.kind);
}

bool FunctionEmitter::computes_in_singles(const ir::Instruction& made) const
{
    if (!forms.is_varying(made.results[0]) || forms.is_wide(made.results[0])) return false;
    return std::none_of(made.operands.begin(), made.operands.end(), [&](ir::Value used) {
        return source.type(used) == ir::Type::real && forms.is_varying(used) && forms.is_wide(used);
    });
}

// The multiplication that made the operand, if it has the precision of what it goes into.
const ir::Instruction* FunctionEmitter::product_to_fuse(ir::Value operand, bool in_singles) const
{
    const ir::Instruction* product = products[operand.index];
    const bool fits = product && forms.is_varying(operand) && computes_in_singles(*product) == in_singles &&
                      forms[operand].is_single == in_singles;
    return fits ? product : nullptr;
}

// Sums and differences of a product; of two products the first is fused.
bool FunctionEmitter::fuse(const ir::Instruction& made, ir::Op op, bool in_singles)
{
    const bool is_difference = op == ir::Op::sub;
    if (!module.fuses() || !forms.is_varying(made.results[0]) || (op != ir::Op::add && !is_difference)) return false;
    for (size_t which = 0; which < 2; ++which) {
        const ir::Instruction* product = product_to_fuse(made.operands[which], in_singles);
        if (!product) continue;
        const Form form{forms[made.results[0]].in_lanes, in_singles};
        Value* factor = value(product->operands[0], form);
        Value* other = value(made.operands[1 - which], form);
        if (is_difference) (which == 0 ? other : factor) = builder.CreateFNeg(which == 0 ? other : factor);
        Value* fused = builder.CreateIntrinsic(llvm::Intrinsic::fma, {factor->getType()},
                                               {factor, value(product->operands[1], form), other});
        define(made.results[0], rounded(fused, forms[made.results[0]].is_single));
        return true;
    }
    return false;
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::Operation& operation)
{
    const Form form = forms[made.results[0]];
    const bool in_singles = computes_in_singles(made);
    if (fuse(made, operation.op, in_singles)) return;
    if (operation.op == ir::Op::mul) products[made.results[0].index] = &made;
    Value* operands[4];
    const size_t count = made.operands.size();
    for (size_t i = 0; i < count; ++i) operands[i] = value(made.operands[i], {form.in_lanes, in_singles});
    llvm::Type* real = in_singles ? builder.getFloatTy() : builder.getDoubleTy();
    Value* result = emit_operation(builder, operation.op, {operands, count}, real,
                                   form.is_single ? builder.getFloatTy() : builder.getDoubleTy(), module.fuses());
    define(made.results[0], source.type(made.results[0]) == ir::Type::real ? rounded(result, form.is_single) : result);
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::RealConstant& constant)
{
    define(made.results[0], llvm::ConstantFP::get(builder.getDoubleTy(), constant.value));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::WordConstant& constant)
{
    const bool is_truth = source.type(made.results[0]) == ir::Type::boolean;
    define(made.results[0], is_truth ? builder.getInt1(constant.bits != 0) : builder.getInt32(constant.bits));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadInput& read)
{
    const auto index = static_cast<size_t>(read.input);
    llvm::Type* real = builder.getDoubleTy();
    if (index >= point_inputs)
        return define(made.results[0],
                      builder.CreateLoad(real, at_offset(arguments.block, (index - point_inputs) * sizeof(double))));
    if (!arguments.is_there)
        return define(made.results[0],
                      rounded(builder.CreateLoad(real, at_offset(arguments.points, index * sizeof(double))),
                              forms[made.results[0]].is_single));
    Value* array = builder.CreateLoad(builder.getPtrTy(), at_offset(arguments.points, index * sizeof(double*)));
    llvm::Type* lanes = llvm::FixedVectorType::get(real, module.lanes);
    ask_ahead(builder, real, array, arguments.first, module.lanes, false);
    Value* loaded =
        builder.CreateMaskedLoad(lanes, builder.CreateInBoundsGEP(real, array, arguments.first),
                                 llvm::Align(alignof(double)), arguments.is_there, llvm::Constant::getNullValue(lanes));
    define(made.results[0], rounded(loaded, forms[made.results[0]].is_single));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadParameter& read)
{
    const ir::Parameter& parameter = arguments.texture->parameters[read.parameter];
    const bool is_boolean = parameter.type == ir::Type::boolean; // held as int32_t
    llvm::Type* held_as = is_boolean ? builder.getInt32Ty() : module.type(parameter.type, {});
    Value* held = builder.CreateLoad(held_as, at_offset(arguments.block, parameter.offset));
    define(made.results[0], is_boolean ? builder.CreateICmpNE(held, builder.getInt32(0)) : held);
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadTable& read)
{
    const Form form = forms[made.results[0]];
    Value* const index = value(made.operands[0]);
    if (form.in_lanes)
        return define(made.results[0], read_in_lanes(module, builder, read.table, index, form.is_single));
    llvm::Type* cells = type(made.results[0]);
    Value* wide = builder.CreateZExt(index, builder.getInt64Ty());
    Value* cell = builder.CreateInBoundsGEP(cells, module.table(read.table, form.is_single), wide);
    define(made.results[0], builder.CreateLoad(cells, cell));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::Call& call)
{
    Signature signature;
    for (ir::Value operand : made.operands) signature.arguments.push_back(forms.is_varying(operand));
    for (ir::Value operand : made.operands) signature.in_lanes.push_back(forms[operand].in_lanes);
    if (!forms.in_order.empty()) // else all of the points' form
        for (ir::Value operand : made.operands) signature.in_order.push_back(forms.in_order[operand.index]);
    for (ir::Value result : made.results) signature.wide_results.push_back(forms.is_wide(result));
    for (ir::Value result : made.results) signature.needed_results.push_back(forms.is_needed(result));
    if (std::find(signature.needed_results.begin(), signature.needed_results.end(), false) ==
        signature.needed_results.end())
        signature.needed_results.clear();
    const ModuleEmitter::Function& callee = module.function(call.function, signature);
    const std::vector<bool>& called = module.called_by_batches;
    if (!source.is_library && !called.empty() && called[call.function])
        callee.code->addFnAttr(llvm::Attribute::NoInline);
    std::vector<Value*> operands;
    for (size_t i = 0; i < made.operands.size(); ++i)
        operands.push_back(
            value(made.operands[i], (*callee.forms)[module.source.functions[call.function].parameters[i]]));
    llvm::CallInst* result = builder.CreateCall(callee.code, operands);
    result->setCallingConv(llvm::CallingConv::Fast);
    if (made.results.size() == 1) return define(made.results[0], result);
    for (unsigned i = 0; i < made.results.size(); ++i) define(made.results[i], builder.CreateExtractValue(result, i));
}

// In no program that passes `verify`.
void FunctionEmitter::emit(const ir::Instruction& made, const ir::PointDerivative&)
{
    define(made.results[0], llvm::ConstantFP::getNaN(type(made.results[0])));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::If& choice)
{
    std::vector<Form> results;
    for (ir::Value result : made.results) results.push_back(forms[result]);
    Value* condition = value(made.operands[0]);
    std::vector<Value*> yields[2];
    if (forms[made.operands[0]].in_lanes) {
        for (size_t i = 0; i < 2; ++i) yields[i] = block(choice.arms[i], results);
        for (size_t i = 0; i < made.results.size(); ++i)
            define(made.results[i], builder.CreateSelect(condition, yields[0][i], yields[1][i]));
        return;
    }
    llvm::BasicBlock* arms[] = {new_block("then"), new_block("else")};
    llvm::BasicBlock* join = new_block("join");
    builder.CreateCondBr(condition, arms[0], arms[1]);
    for (size_t i = 0; i < 2; ++i) {
        builder.SetInsertPoint(arms[i]);
        yields[i] = block(choice.arms[i], results);
        arms[i] = builder.GetInsertBlock(); // where the arm ends
        builder.CreateBr(join);
    }
    builder.SetInsertPoint(join);
    for (size_t i = 0; i < made.results.size(); ++i) {
        llvm::PHINode* phi = builder.CreatePHI(type(made.results[i]), 2);
        phi->addIncoming(yields[0][i], arms[0]);
        phi->addIncoming(yields[1][i], arms[1]);
        define(made.results[i], phi);
    }
}

} // namespace haptel::jit
