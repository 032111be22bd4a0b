#include "jit/codegen_function.h"

#include "jit/codegen_operation.h"
#include "jit/uniformity.h"
#include "lang/abi.h"

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
                                 const std::vector<bool>& parameters, const EntryArguments& entry)
    : module(owner)
    , source(from)
    , target(to)
    , arguments(entry)
    , varies(owner.lanes > 1 ? varying_values(from, parameters) : std::vector<bool>(from.value_types.size()))
    , builder(&to.back())
    , values(from.value_types.size())
{
}

Value* FunctionEmitter::value(ir::Value used, bool in_lanes)
{
    const bool to_all = in_lanes && !is_varying(used) && source.type(used) != ir::Type::image;
    return to_all ? builder.CreateVectorSplat(module.lanes, value(used)) : value(used);
}

llvm::BasicBlock* FunctionEmitter::new_block(const char* name)
{
    return llvm::BasicBlock::Create(target.getContext(), name, &target);
}

Value* FunctionEmitter::at_offset(Value* base, size_t offset)
{
    return builder.CreateConstInBoundsGEP1_64(builder.getInt8Ty(), base, offset);
}

std::vector<Value*> FunctionEmitter::block(const ir::Block& from, const std::vector<bool>& yields_in_lanes)
{
    for (const ir::Instruction& instruction : from.instructions)
        std::visit([&](const auto& kind) { emit(instruction, kind); }, instruction.kind);
    std::vector<Value*> yields;
    for (size_t i = 0; i < from.yields.size(); ++i) yields.push_back(value(from.yields[i], yields_in_lanes[i]));
    return yields;
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::Operation& operation)
{
    Value* operands[4];
    const size_t count = made.operands.size();
    for (size_t i = 0; i < count; ++i) operands[i] = value(made.operands[i], is_varying(made.results[0]));
    define(made.results[0], emit_operation(builder, operation.op, {operands, count}));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::RealConstant& constant)
{
    define(made.results[0], llvm::ConstantFP::get(builder.getDoubleTy(), constant.value));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::IntConstant& constant)
{
    define(made.results[0], builder.getInt32(constant.bits));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::BoolConstant& constant)
{
    define(made.results[0], builder.getInt1(constant.value));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadInput& read)
{
    const auto index = static_cast<size_t>(read.input);
    llvm::Type* real = builder.getDoubleTy();
    if (index >= point_inputs)
        return define(made.results[0],
                      builder.CreateLoad(real, at_offset(arguments.block, (index - point_inputs) * sizeof(double))));
    if (!arguments.is_there)
        return define(made.results[0], builder.CreateLoad(real, at_offset(arguments.points, index * sizeof(double))));
    Value* array = builder.CreateLoad(builder.getPtrTy(), at_offset(arguments.points, index * sizeof(double*)));
    llvm::Type* lanes = type(made.results[0]);
    define(made.results[0], builder.CreateMaskedLoad(lanes, builder.CreateInBoundsGEP(real, array, arguments.first),
                                                     llvm::Align(alignof(double)), arguments.is_there,
                                                     llvm::Constant::getNullValue(lanes)));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadParameter& read)
{
    const ir::Parameter& parameter = arguments.texture->parameters[read.parameter];
    const bool is_boolean = parameter.type == ir::Type::boolean; // held as int32_t
    llvm::Type* held_as = is_boolean ? builder.getInt32Ty() : module.type(parameter.type, false);
    Value* held = builder.CreateLoad(held_as, at_offset(arguments.block, parameter.offset));
    define(made.results[0], is_boolean ? builder.CreateICmpNE(held, builder.getInt32(0)) : held);
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::ReadTable& read)
{
    llvm::GlobalVariable* table = module.table(read.table);
    const bool varying = is_varying(made.results[0]);
    llvm::Type* wide = builder.getInt64Ty();
    Value* index =
        builder.CreateZExt(value(made.operands[0]), varying ? llvm::FixedVectorType::get(wide, module.lanes) : wide);
    Value* cell = builder.CreateInBoundsGEP(module.type(module.source.tables[read.table].element, false), table, index);
    if (!varying) return define(made.results[0], builder.CreateLoad(type(made.results[0]), cell));
    const uint64_t size = module.source.tables[read.table].element == ir::Type::real ? sizeof(double) : sizeof(uint32_t);
    define(made.results[0], builder.CreateMaskedGather(type(made.results[0]), cell, llvm::Align(size)));
}

void FunctionEmitter::emit(const ir::Instruction& made, const ir::Call& call)
{
    std::vector<Value*> operands;
    std::vector<bool> form;
    for (ir::Value operand : made.operands) {
        operands.push_back(value(operand));
        form.push_back(is_varying(operand));
    }
    llvm::CallInst* result = builder.CreateCall(module.function(call.function, form), operands);
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
    std::vector<bool> forms;
    for (ir::Value result : made.results) forms.push_back(is_varying(result));
    Value* condition = value(made.operands[0]);
    std::vector<Value*> yields[2];
    if (is_varying(made.operands[0])) {
        for (size_t i = 0; i < 2; ++i) yields[i] = block(choice.arms[i], forms);
        for (size_t i = 0; i < made.results.size(); ++i)
            define(made.results[i], builder.CreateSelect(condition, yields[0][i], yields[1][i]));
        return;
    }
    llvm::BasicBlock* arms[] = {new_block("then"), new_block("else")};
    llvm::BasicBlock* join = new_block("join");
    builder.CreateCondBr(condition, arms[0], arms[1]);
    for (size_t i = 0; i < 2; ++i) {
        builder.SetInsertPoint(arms[i]);
        yields[i] = block(choice.arms[i], forms);
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

void FunctionEmitter::emit(const ir::Instruction& made, const ir::For& loop)
{
    const ir::Block& body = loop.body[0];
    Value* const count = value(made.operands[0]);
    const bool count_varies = is_varying(made.operands[0]);
    Value* const largest = count_varies ? builder.CreateIntMaxReduce(count, true) : count;
    std::vector<Value*> initial;
    std::vector<bool> forms;
    for (size_t i = 1; i < body.parameters.size(); ++i) {
        forms.push_back(is_varying(body.parameters[i]));
        initial.push_back(value(made.operands[i], forms.back()));
    }
    llvm::BasicBlock* before = builder.GetInsertBlock();
    llvm::BasicBlock* head = new_block("loop");
    llvm::BasicBlock* inside = new_block("body");
    llvm::BasicBlock* after = new_block("done");
    builder.CreateBr(head);

    builder.SetInsertPoint(head);
    llvm::PHINode* iteration = builder.CreatePHI(builder.getInt32Ty(), 2);
    iteration->addIncoming(builder.getInt32(0), before);
    define(body.parameters[0], iteration);
    std::vector<llvm::PHINode*> carried;
    for (size_t i = 0; i < initial.size(); ++i) {
        carried.push_back(builder.CreatePHI(initial[i]->getType(), 2));
        carried[i]->addIncoming(initial[i], before);
        define(body.parameters[i + 1], carried[i]);
    }
    builder.CreateCondBr(builder.CreateICmpSLT(iteration, largest), inside, after);

    builder.SetInsertPoint(inside);
    std::vector<Value*> next = block(body, forms);
    if (count_varies) {
        Value* goes_on = builder.CreateICmpSLT(builder.CreateVectorSplat(module.lanes, iteration), count);
        for (size_t i = 0; i < next.size(); ++i) next[i] = builder.CreateSelect(goes_on, next[i], carried[i]);
    }
    iteration->addIncoming(builder.CreateNSWAdd(iteration, builder.getInt32(1)), builder.GetInsertBlock());
    for (size_t i = 0; i < next.size(); ++i) carried[i]->addIncoming(next[i], builder.GetInsertBlock());
    builder.CreateBr(head);

    builder.SetInsertPoint(after);
    for (size_t i = 0; i < made.results.size(); ++i) define(made.results[i], carried[i]);
}

} // namespace haptel::jit
