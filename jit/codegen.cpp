#include "jit/codegen.h"

#include "jit/codegen_operation.h"
#include "jit/llvm.h"
#include "lang/abi.h"

#include <cstddef>

namespace haptel::jit {

namespace {

using llvm::Value;

// ir::Input counts the doubles of haptel_point, then those of haptel_block_head.
constexpr size_t point_inputs = static_cast<size_t>(ir::Input::center_x);
static_assert(sizeof(haptel_point) == point_inputs * sizeof(double));
static_assert(sizeof(haptel_block_head) == (ir::input_count - point_inputs) * sizeof(double));
static_assert(offsetof(haptel_point, time_s) == static_cast<size_t>(ir::Input::time) * sizeof(double));
static_assert(offsetof(haptel_point, uv_dp) == static_cast<size_t>(ir::Input::uv_dp_00) * sizeof(double));
static_assert(offsetof(haptel_block_head, footprint_m) ==
              (static_cast<size_t>(ir::Input::footprint) - point_inputs) * sizeof(double));

// Of the entry being emitted; null in other functions.
struct EntryArguments {
    Value* point = nullptr;
    Value* block = nullptr;
    const ir::Texture* texture = nullptr;
};

class ModuleEmitter {
public:
    ModuleEmitter(const ir::Module& from, llvm::Module& to) : source(from), target(to) {}

    void entry(const EntryPoint& point);
    llvm::Function* function(uint32_t index) { return functions[index]; }
    llvm::GlobalVariable* table(uint32_t index);
    llvm::Type* type(ir::Type type);

    const ir::Module& source;
    llvm::Module& target;

private:
    void internal_function(uint32_t index);
    void reach(uint32_t index);

    std::vector<llvm::Function*> functions = std::vector<llvm::Function*>(source.functions.size());
    std::vector<llvm::GlobalVariable*> tables = std::vector<llvm::GlobalVariable*>(source.tables.size());
};

// Emits the body of one function; structured regions become basic blocks and phis.
class FunctionEmitter {
public:
    FunctionEmitter(ModuleEmitter& owner, const ir::Function& from, llvm::Function& to, EntryArguments entry)
        : module(owner)
        , source(from)
        , target(to)
        , arguments(entry)
        , builder(llvm::BasicBlock::Create(to.getContext(), "", &to))
        , values(from.value_types.size())
    {
    }

    void define(ir::Value value, Value* made) { values[value.index] = made; }
    std::vector<Value*> body() { return block(source.body); }
    llvm::IRBuilder<>& at_end() { return builder; }

private:
    ModuleEmitter& module;
    const ir::Function& source;
    llvm::Function& target;
    const EntryArguments arguments;
    llvm::IRBuilder<> builder;
    std::vector<Value*> values; // by ir::Value::index

    Value* value(ir::Value used) const { return values[used.index]; }
    std::vector<Value*> all(const std::vector<ir::Value>& used) const
    {
        std::vector<Value*> result;
        for (ir::Value one : used) result.push_back(value(one));
        return result;
    }
    llvm::BasicBlock* new_block(const char* name)
    {
        return llvm::BasicBlock::Create(target.getContext(), name, &target);
    }
    llvm::Type* type(ir::Value of) { return module.type(source.type(of)); }
    Value* load(llvm::Type* loaded, Value* base, size_t offset)
    {
        return builder.CreateLoad(loaded, builder.CreateConstInBoundsGEP1_64(builder.getInt8Ty(), base, offset));
    }

    std::vector<Value*> block(const ir::Block& from)
    {
        for (const ir::Instruction& instruction : from.instructions)
            std::visit([&](const auto& kind) { emit(instruction, kind); }, instruction.kind);
        return all(from.yields);
    }

    void emit(const ir::Instruction& made, const ir::Operation& operation)
    {
        Value* operands[4];
        const size_t count = made.operands.size();
        for (size_t i = 0; i < count; ++i) operands[i] = value(made.operands[i]);
        define(made.results[0], emit_operation(builder, operation.op, {operands, count}));
    }
    void emit(const ir::Instruction& made, const ir::RealConstant& constant)
    {
        define(made.results[0], llvm::ConstantFP::get(builder.getDoubleTy(), constant.value));
    }
    void emit(const ir::Instruction& made, const ir::IntConstant& constant)
    {
        define(made.results[0], builder.getInt32(constant.bits));
    }
    void emit(const ir::Instruction& made, const ir::BoolConstant& constant)
    {
        define(made.results[0], builder.getInt1(constant.value));
    }
    void emit(const ir::Instruction& made, const ir::ReadInput& read)
    {
        const auto index = static_cast<size_t>(read.input);
        const bool of_point = index < point_inputs;
        define(made.results[0], load(builder.getDoubleTy(), of_point ? arguments.point : arguments.block,
                                     (of_point ? index : index - point_inputs) * sizeof(double)));
    }
    void emit(const ir::Instruction& made, const ir::ReadParameter& read)
    {
        const ir::Parameter& parameter = arguments.texture->parameters[read.parameter];
        const bool is_boolean = parameter.type == ir::Type::boolean; // held as int32_t
        Value* held =
            load(is_boolean ? builder.getInt32Ty() : module.type(parameter.type), arguments.block, parameter.offset);
        define(made.results[0], is_boolean ? builder.CreateICmpNE(held, builder.getInt32(0)) : held);
    }
    void emit(const ir::Instruction& made, const ir::ReadTable& read)
    {
        llvm::GlobalVariable* table = module.table(read.table);
        Value* index = builder.CreateZExt(value(made.operands[0]), builder.getInt64Ty());
        Value* cell = builder.CreateInBoundsGEP(table->getValueType(), table, {builder.getInt64(0), index});
        define(made.results[0], builder.CreateLoad(type(made.results[0]), cell));
    }
    void emit(const ir::Instruction& made, const ir::Call& call)
    {
        llvm::CallInst* result = builder.CreateCall(module.function(call.function), all(made.operands));
        result->setCallingConv(llvm::CallingConv::Fast);
        if (made.results.size() == 1) return define(made.results[0], result);
        for (unsigned i = 0; i < made.results.size(); ++i)
            define(made.results[i], builder.CreateExtractValue(result, i));
    }
    void emit(const ir::Instruction& made, const ir::PointDerivative&) // in no program that passes `verify`
    {
        define(made.results[0], llvm::ConstantFP::getNaN(builder.getDoubleTy()));
    }
    void emit(const ir::Instruction& made, const ir::If& choice)
    {
        llvm::BasicBlock* arms[] = {new_block("then"), new_block("else")};
        llvm::BasicBlock* join = new_block("join");
        builder.CreateCondBr(value(made.operands[0]), arms[0], arms[1]);
        std::vector<Value*> yields[2];
        for (size_t i = 0; i < 2; ++i) {
            builder.SetInsertPoint(arms[i]);
            yields[i] = block(choice.arms[i]);
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
    void emit(const ir::Instruction& made, const ir::For& loop)
    {
        const ir::Block& body = loop.body[0];
        llvm::BasicBlock* before = builder.GetInsertBlock();
        llvm::BasicBlock* head = new_block("loop");
        llvm::BasicBlock* inside = new_block("body");
        llvm::BasicBlock* after = new_block("done");
        builder.CreateBr(head);

        builder.SetInsertPoint(head);
        std::vector<llvm::PHINode*> carried;
        for (size_t i = 0; i < body.parameters.size(); ++i) {
            carried.push_back(builder.CreatePHI(type(body.parameters[i]), 2));
            carried[i]->addIncoming(i == 0 ? builder.getInt32(0) : value(made.operands[i]), before);
            define(body.parameters[i], carried[i]);
        }
        builder.CreateCondBr(builder.CreateICmpSLT(carried[0], value(made.operands[0])), inside, after);

        builder.SetInsertPoint(inside);
        std::vector<Value*> next = block(body);
        next.insert(next.begin(), builder.CreateNSWAdd(carried[0], builder.getInt32(1)));
        for (size_t i = 0; i < carried.size(); ++i) carried[i]->addIncoming(next[i], builder.GetInsertBlock());
        builder.CreateBr(head);

        builder.SetInsertPoint(after);
        for (size_t i = 0; i < made.results.size(); ++i) define(made.results[i], carried[i + 1]);
    }
};

llvm::Type* ModuleEmitter::type(ir::Type type)
{
    llvm::LLVMContext& context = target.getContext();
    switch (type) {
    case ir::Type::real: return llvm::Type::getDoubleTy(context);
    case ir::Type::i32:
    case ir::Type::u32: return llvm::Type::getInt32Ty(context);
    case ir::Type::boolean: return llvm::Type::getInt1Ty(context);
    case ir::Type::image: return llvm::PointerType::getUnqual(context);
    }
    return nullptr;
}

llvm::GlobalVariable* ModuleEmitter::table(uint32_t index)
{
    if (tables[index]) return tables[index];
    const ir::Table& table = source.tables[index];
    llvm::LLVMContext& context = target.getContext();
    llvm::Constant* cells = table.element == ir::Type::real ? llvm::ConstantDataArray::get(context, table.reals)
                                                            : llvm::ConstantDataArray::get(context, table.words);
    tables[index] = new llvm::GlobalVariable(target, cells->getType(), true, llvm::GlobalValue::InternalLinkage, cells);
    tables[index]->setUnnamedAddr(llvm::GlobalValue::UnnamedAddr::Global);
    return tables[index];
}

template <typename Visit>
void for_each_call(const ir::Block& block, Visit&& visit)
{
    for (const ir::Instruction& instruction : block.instructions) {
        if (auto* call = std::get_if<ir::Call>(&instruction.kind)) visit(call->function);
        if (auto* choice = std::get_if<ir::If>(&instruction.kind))
            for (const ir::Block& arm : choice->arms) for_each_call(arm, visit);
        if (auto* loop = std::get_if<ir::For>(&instruction.kind)) for_each_call(loop->body[0], visit);
    }
}

// Emits what the function calls, callees first: a call refers to a smaller index.
void ModuleEmitter::reach(uint32_t index)
{
    std::vector<bool> needed(index + 1, false);
    needed[index] = true;
    for (uint32_t i = index + 1; i-- > 0;)
        if (needed[i]) for_each_call(source.functions[i].body, [&](uint32_t callee) { needed[callee] = true; });
    for (uint32_t i = 0; i < index; ++i)
        if (needed[i] && !functions[i]) internal_function(i);
}

void ModuleEmitter::internal_function(uint32_t index)
{
    const ir::Function& from = source.functions[index];
    std::vector<llvm::Type*> parameters, results;
    for (ir::Value parameter : from.parameters) parameters.push_back(type(from.type(parameter)));
    for (ir::Value result : from.body.yields) results.push_back(type(from.type(result)));
    llvm::Type* result = results.size() == 1 ? results[0] : llvm::StructType::get(target.getContext(), results);
    auto* function = llvm::Function::Create(llvm::FunctionType::get(result, parameters, false),
                                            llvm::GlobalValue::InternalLinkage, from.name, target);
    function->setCallingConv(llvm::CallingConv::Fast);
    function->setDoesNotThrow();
    const bool reads_images = std::any_of(from.parameters.begin(), from.parameters.end(),
                                          [&](ir::Value value) { return from.type(value) == ir::Type::image; });
    reads_images ? function->setOnlyReadsMemory() : function->setDoesNotAccessMemory();
    function->setWillReturn();
    functions[index] = function;

    FunctionEmitter emitter(*this, from, *function, {});
    for (size_t i = 0; i < from.parameters.size(); ++i)
        emitter.define(from.parameters[i], function->getArg(static_cast<unsigned>(i)));
    const std::vector<Value*> yields = emitter.body();
    if (yields.size() == 1)
        emitter.at_end().CreateRet(yields[0]);
    else
        emitter.at_end().CreateAggregateRet(yields.data(), static_cast<unsigned>(yields.size()));
}

void ModuleEmitter::entry(const EntryPoint& point)
{
    const bool with_gradient = point.kind == EntryPoint::Kind::height_gradient;
    const uint32_t index = with_gradient ? point.texture->height_gradient : point.texture->height;
    reach(index);

    llvm::LLVMContext& context = target.getContext();
    llvm::Type* pointer = llvm::PointerType::getUnqual(context);
    auto* type = llvm::FunctionType::get(llvm::Type::getVoidTy(context), {pointer, pointer, pointer}, false);
    auto* function = llvm::Function::Create(type, llvm::GlobalValue::ExternalLinkage, point.name, target);
    function->setDoesNotThrow();
    for (unsigned i = 0; i < 3; ++i) {
        function->addParamAttr(i, llvm::Attribute::NoAlias);
        function->addParamAttr(i, llvm::Attribute::NoCapture);
    }
    function->addParamAttr(0, llvm::Attribute::ReadOnly);
    function->addParamAttr(1, llvm::Attribute::ReadOnly);

    FunctionEmitter emitter(*this, source.functions[index], *function,
                            {function->getArg(0), function->getArg(1), point.texture});
    const std::vector<Value*> yields = emitter.body();
    llvm::IRBuilder<>& builder = emitter.at_end();
    Value* sample = function->getArg(2);
    auto store = [&](Value* value, size_t offset) {
        builder.CreateStore(value, builder.CreateConstInBoundsGEP1_64(builder.getInt8Ty(), sample, offset));
    };
    store(yields[0], offsetof(haptel_sample, height_m));
    if (with_gradient) {
        for (size_t i = 0; i < 3; ++i) store(yields[1 + i], offsetof(haptel_sample, gradient) + i * sizeof(double));
        const std::pair<uint32_t, size_t> outputs[] = {
            {HAPTEL_WRITES_STIFFNESS_SCALE, offsetof(haptel_sample, stiffness_scale)},
            {HAPTEL_WRITES_FRICTION_SCALE, offsetof(haptel_sample, friction_scale)}};
        size_t next = 5;
        for (const auto& [bit, offset] : outputs)
            store(point.texture->writes & bit ? yields[next++] : llvm::ConstantFP::get(builder.getDoubleTy(), 1),
                  offset);
    }
    store(yields[with_gradient ? 4 : 1], offsetof(haptel_sample, faults));
    builder.CreateRetVoid();
}

} // namespace

std::unique_ptr<llvm::Module> generate(const ir::Module& module, std::span<const EntryPoint> entries,
                                       llvm::LLVMContext& context)
{
    auto generated = std::make_unique<llvm::Module>("textures", context);
    ModuleEmitter emitter(module, *generated);
    for (const EntryPoint& entry : entries) emitter.entry(entry);
    return generated;
}

} // namespace haptel::jit
