#include "jit/codegen/codegen_function.h"

#include "jit/codegen/codegen_math.h"
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

FunctionEmitter::FunctionEmitter(ModuleEmitter& owner, llvm::IRBuilder<>& to, const ValueForms& value_forms,
                                 const EntryArguments& entry)
    : module(owner)
    , source(value_forms.function)
    , forms(value_forms)
    , arguments(entry)
    , builder(to)
    , values(source.value_types.size())
    , products(source.value_types.size())
{
}

Value* FunctionEmitter::value(ir::Value used)
{
    Value* const held = values[used.index];
    return held || forms.is_needed(used) ? held : llvm::PoisonValue::get(type(used));
}

Value* FunctionEmitter::value(ir::Value used, Form wanted)
{
    Value* held = value(used);
    if (source.type(used) == ir::Type::real) held = rounded(held, wanted.is_single);
    return wanted.in_lanes && !forms[used].in_lanes ? builder.CreateVectorSplat(module.lanes, held) : held;
}

bool FunctionEmitter::is_needed(const ir::Instruction& made) const
{
    return std::any_of(made.results.begin(), made.results.end(),
                       [&](ir::Value result) { return forms.is_needed(result); });
}

Value* FunctionEmitter::rounded(Value* real, bool to_single)
{
    llvm::Type* const element = to_single ? builder.getFloatTy() : builder.getDoubleTy();
    return builder.CreateFPCast(real, real->getType()->getWithNewType(element));
}

Values FunctionEmitter::block(const ir::Block& from, const std::vector<Form>& yield_forms)
{
    emit_rest(from);
    Values yields;
    for (size_t i = 0; i < from.yields.size(); ++i) yields.push_back(value(from.yields[i], yield_forms[i]));
    return yields;
}

void FunctionEmitter::emit_rest(const ir::Block& from)
{
    for (const ir::Instruction& instruction : from.instructions)
        if (!done.contains(&instruction)) emit(instruction);
}

void FunctionEmitter::emit_ahead(const std::vector<const ir::Instruction*>& instructions)
{
    for (const ir::Instruction* one : instructions) emit(*one);
    done.insert(instructions.begin(), instructions.end());
}

void FunctionEmitter::emit(const ir::Instruction& made)
{
    if (!is_needed(made)) return;
    const Values results = std::visit([&](const auto& kind) { return emit(made, kind); }, made.kind);
    for (size_t i = 0; i < results.size(); ++i) define(made.results[i], results[i]);
}

bool FunctionEmitter::computes_in_singles(const ir::Instruction& made) const
{
    if (!forms.is_varying(made.results[0]) || forms.is_wide(made.results[0])) return false;
    return std::none_of(made.operands.begin(), made.operands.end(), [&](ir::Value used) {
        return source.type(used) == ir::Type::real && forms.is_varying(used) && forms.is_wide(used);
    });
}

// Sums and differences of a product that has their precision; of two products the first is fused. Null: there is none.
Value* FunctionEmitter::fused(const ir::Instruction& made, ir::Op op, bool in_singles)
{
    const bool is_difference = op == ir::Op::sub;
    if (!module.fuses() || !forms.is_varying(made.results[0]) || (op != ir::Op::add && !is_difference)) return nullptr;
    const Form form{forms[made.results[0]].in_lanes, in_singles};
    for (size_t which = 0; which < 2; ++which) {
        const ir::Value operand = made.operands[which];
        const ir::Instruction* product = products[operand.index];
        if (!product || !forms.is_varying(operand) || computes_in_singles(*product) != in_singles ||
            forms[operand].is_single != in_singles)
            continue;
        Value* factor = value(product->operands[0], form);
        Value* other = value(made.operands[1 - which], form);
        if (is_difference) (which == 0 ? other : factor) = builder.CreateFNeg(which == 0 ? other : factor);
        return builder.CreateIntrinsic(llvm::Intrinsic::fma, {factor->getType()},
                                       {factor, value(product->operands[1], form), other});
    }
    return nullptr;
}

Values FunctionEmitter::emit(const ir::Instruction& made, const ir::Operation& operation)
{
    const Form form = forms[made.results[0]];
    const bool in_singles = computes_in_singles(made);
    if (Value* const sum = fused(made, operation.op, in_singles)) return {rounded(sum, form.is_single)};
    if (operation.op == ir::Op::mul) products[made.results[0].index] = &made;
    Values operands;
    for (ir::Value operand : made.operands) operands.push_back(value(operand, {form.in_lanes, in_singles}));
    llvm::Type* real = in_singles ? builder.getFloatTy() : builder.getDoubleTy();
    Value* result = emit_operation(builder, operation.op, operands, real,
                                   form.is_single ? builder.getFloatTy() : builder.getDoubleTy(), module.fuses());
    return {source.type(made.results[0]) == ir::Type::real ? rounded(result, form.is_single) : result};
}

Values FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadInput& read)
{
    const auto index = static_cast<size_t>(read.input);
    const bool is_single = forms[made.results[0]].is_single;
    llvm::Type* const real = builder.getDoubleTy();
    if (index >= point_inputs || !arguments.is_there) {
        Value* const place = index < point_inputs
                                 ? at_offset(builder, arguments.points, index * sizeof(double))
                                 : at_offset(builder, arguments.block, (index - point_inputs) * sizeof(double));
        return {rounded(builder.CreateLoad(real, place), is_single)};
    }
    Value* const array =
        builder.CreateLoad(builder.getPtrTy(), at_offset(builder, arguments.points, index * sizeof(double*)));
    llvm::Type* const lanes = llvm::FixedVectorType::get(real, module.lanes);
    ask_ahead(builder, real, array, arguments.first, module.lanes, false);
    Value* const loaded =
        builder.CreateMaskedLoad(lanes, builder.CreateInBoundsGEP(real, array, arguments.first),
                                 llvm::Align(alignof(double)), arguments.is_there, llvm::Constant::getNullValue(lanes));
    return {rounded(loaded, is_single)};
}

Values FunctionEmitter::emit(const ir::Instruction&, const ir::ReadParameter& read)
{
    const ir::Parameter& parameter = arguments.texture->parameters[read.parameter];
    const bool is_boolean = parameter.type == ir::Type::boolean; // held as int32_t
    llvm::Type* held_as = is_boolean ? builder.getInt32Ty() : module.type(parameter.type, {});
    Value* held = builder.CreateLoad(held_as, at_offset(builder, arguments.block, parameter.offset));
    return {is_boolean ? builder.CreateIsNotNull(held) : held};
}

Values FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadTable& read)
{
    const Form form = forms[made.results[0]];
    Value* const index = value(made.operands[0]);
    if (form.in_lanes) return {module.read_in_lanes(builder, read.table, index, form.is_single)};
    llvm::Type* cells = type(made.results[0]);
    Value* wide = builder.CreateZExt(index, builder.getInt64Ty());
    Value* cell = builder.CreateInBoundsGEP(cells, module.table(read.table, form.is_single), wide);
    return {builder.CreateLoad(cells, cell)};
}

Values FunctionEmitter::emit(const ir::Instruction& made, const ir::Call& call)
{
    Signature signature;
    for (ir::Value operand : made.operands) {
        signature.arguments.push_back(forms.is_varying(operand));
        signature.in_lanes.push_back(forms[operand].in_lanes);
        if (!forms.in_order.empty())
            signature.in_order.push_back(forms.in_order[operand.index]); // else all of the points' form
    }
    for (ir::Value result : made.results) {
        signature.wide_results.push_back(forms.is_wide(result));
        signature.needed_results.push_back(forms.is_needed(result));
    }
    if (std::ranges::count(signature.needed_results, false) == 0) signature.needed_results.clear();
    const ModuleEmitter::Function& callee = module.function(call.function, signature);
    const std::vector<bool>& called = module.called_by_batches;
    if (!source.is_library && !called.empty() && called[call.function])
        callee.code->addFnAttr(llvm::Attribute::NoInline);
    Values operands;
    for (size_t i = 0; i < made.operands.size(); ++i)
        operands.push_back(
            value(made.operands[i], (*callee.forms)[module.source.functions[call.function].parameters[i]]));
    llvm::CallInst* result = builder.CreateCall(callee.code, operands);
    result->setCallingConv(llvm::CallingConv::Fast);
    if (made.results.size() == 1) return {result};
    Values results;
    for (unsigned i = 0; i < made.results.size(); ++i) results.push_back(builder.CreateExtractValue(result, i));
    return results;
}

Values FunctionEmitter::emit(const ir::Instruction& made, const ir::If& choice)
{
    std::vector<Form> held;
    for (ir::Value result : made.results) held.push_back(forms[result]);
    Value* condition = value(made.operands[0]);
    Values yields[2], results;
    if (forms[made.operands[0]].in_lanes) {
        for (size_t i = 0; i < 2; ++i) yields[i] = block(choice.arms[i], held);
        for (size_t i = 0; i < made.results.size(); ++i)
            results.push_back(builder.CreateSelect(condition, yields[0][i], yields[1][i]));
        return results;
    }
    llvm::Function* const function = builder.GetInsertBlock()->getParent();
    llvm::BasicBlock* arms[] = {llvm::BasicBlock::Create(builder.getContext(), "then", function),
                                llvm::BasicBlock::Create(builder.getContext(), "else", function)};
    llvm::BasicBlock* join = llvm::BasicBlock::Create(builder.getContext(), "join", function);
    builder.CreateCondBr(condition, arms[0], arms[1]);
    for (size_t i = 0; i < 2; ++i) {
        builder.SetInsertPoint(arms[i]);
        yields[i] = block(choice.arms[i], held);
        arms[i] = builder.GetInsertBlock(); // where the arm ends
        builder.CreateBr(join);
    }
    builder.SetInsertPoint(join);
    for (size_t i = 0; i < made.results.size(); ++i) {
        llvm::PHINode* phi = builder.CreatePHI(type(made.results[i]), 2);
        for (size_t arm = 0; arm < 2; ++arm) phi->addIncoming(yields[arm][i], arms[arm]);
        results.push_back(phi);
    }
    return results;
}

} // namespace haptel::jit
