#include "jit/codegen/codegen.h"

#include "jit/codegen/codegen_function.h"
#include "jit/codegen/kernels.h"
#include "lang/abi/abi.h"

#include <cstddef>
#include <optional>

namespace haptel::jit {

namespace {

using llvm::Value;

// A number of the sample: where it stands in haptel_sample and in haptel_samples, and which result of the entry it is.
struct Output {
    size_t offset, array_offset;
    std::optional<size_t> yield; // none: 1
};

// `faults_alone`: the result that holds the faults of the height alone, the last.
std::vector<Output> outputs_of(const EntryPoint& entry, size_t faults_alone)
{
    std::vector<Output> outputs{{offsetof(haptel_sample, height_m), offsetof(haptel_samples, height_m), 0},
                                {offsetof(haptel_sample, faults), offsetof(haptel_samples, faults), faults_alone}};
    if (entry.kind == EntryPoint::Kind::height) return outputs;
    outputs[1].yield = 4;
    for (size_t i = 0; i < 3; ++i)
        outputs.push_back({offsetof(haptel_sample, gradient) + i * sizeof(double),
                           offsetof(haptel_samples, gradient) + i * sizeof(double*), 1 + i});
    outputs.push_back({offsetof(haptel_sample, stiffness_scale), offsetof(haptel_samples, stiffness_scale), {}});
    outputs.push_back({offsetof(haptel_sample, friction_scale), offsetof(haptel_samples, friction_scale), {}});
    size_t next = 5;
    for (uint32_t bit = 0; bit < 2; ++bit)
        if (entry.texture->writes >> bit & 1) outputs[5 + bit].yield = next++;
    return outputs;
}

class EntryEmitter {
public:
    EntryEmitter(ModuleEmitter& owner, const EntryPoint& point)
        : module(owner)
        , entry(point)
        , source(owner.source.functions[function_of(point)])
        , outputs(outputs_of(point, source.body.yields.size() - 1))
    {
    }

    void one_point()
    {
        llvm::Function& function = declare({pointer(), pointer(), pointer()}, 1);
        llvm::BasicBlock::Create(context(), "", &function);
        const ValueForms forms = entry_forms();
        FunctionEmitter emitter(module, source, function, forms,
                                {.points = function.getArg(0), .block = function.getArg(1), .texture = entry.texture});
        const std::vector<Value*> yields = emitter.body(results({}));
        llvm::IRBuilder<>& builder = emitter.at_end();
        for (const Output& output : outputs)
            builder.CreateStore(result(output, yields), place(builder, function.getArg(2), output.offset));
        builder.CreateRetVoid();
    }

    // A loop over groups of lanes, the last of which may be short.
    void batch()
    {
        llvm::Type* index_type = llvm::Type::getInt64Ty(context());
        llvm::Function& function = declare({pointer(), index_type, pointer(), pointer()}, 2);
        llvm::BasicBlock* before = llvm::BasicBlock::Create(context(), "", &function);
        llvm::BasicBlock* head = llvm::BasicBlock::Create(context(), "points", &function);
        llvm::BasicBlock* after = llvm::BasicBlock::Create(context(), "done", &function);
        llvm::BasicBlock* group = llvm::BasicBlock::Create(context(), "group", &function);
        Value* const count = function.getArg(1);

        llvm::IRBuilder<> outside(before);
        outside.CreateBr(head);
        outside.SetInsertPoint(head);
        llvm::PHINode* first = outside.CreatePHI(index_type, 2);
        first->addIncoming(outside.getInt64(0), before);
        outside.CreateCondBr(outside.CreateICmpULT(first, count), group, after);
        outside.SetInsertPoint(after);
        outside.CreateRetVoid();

        outside.SetInsertPoint(group);
        llvm::Type* indices = llvm::FixedVectorType::get(index_type, module.lanes);
        Value* index =
            outside.CreateAdd(outside.CreateVectorSplat(module.lanes, first), outside.CreateStepVector(indices));
        Value* is_there = outside.CreateICmpULT(index, outside.CreateVectorSplat(module.lanes, count));
        const ValueForms forms = entry_forms();
        FunctionEmitter emitter(module, source, function, forms,
                                {function.getArg(0), function.getArg(2), entry.texture, first, is_there});
        const std::vector<Value*> yields = emitter.body(results({.in_lanes = true}));
        llvm::IRBuilder<>& builder = emitter.at_end();
        for (const Output& output : outputs)
            store_lanes(builder, result(output, yields), place(builder, function.getArg(3), output.array_offset), first,
                        is_there);
        first->addIncoming(builder.CreateAdd(first, builder.getInt64(module.lanes)), builder.GetInsertBlock());
        builder.CreateBr(head);
    }

private:
    ModuleEmitter& module;
    const EntryPoint& entry;
    const ir::Function& source;
    const std::vector<Output> outputs;

    llvm::LLVMContext& context() { return module.target.getContext(); }
    llvm::Type* pointer() { return llvm::PointerType::getUnqual(context()); }
    ValueForms entry_forms()
    {
        Signature signature;
        signature.wide_results.resize(source.body.yields.size());
        signature.needed_results.resize(source.body.yields.size());
        for (const Output& output : outputs)
            if (output.yield) signature.needed_results[*output.yield] = true;
        if (entry.kind == EntryPoint::Kind::height_gradient) signature.needed_results.clear();
        return module.forms(function_of(entry), signature);
    }
    std::vector<Form> results(Form form) const { return std::vector(source.body.yields.size(), form); }

    // The last argument is what is written.
    llvm::Function& declare(std::vector<llvm::Type*> arguments, unsigned block)
    {
        auto* type = llvm::FunctionType::get(llvm::Type::getVoidTy(context()), arguments, false);
        auto* function =
            llvm::Function::Create(type, llvm::GlobalValue::ExternalLinkage, symbol_of(entry), module.target);
        function->setDoesNotThrow();
        for (unsigned i : {0u, block, block + 1}) {
            function->addParamAttr(i, llvm::Attribute::NoAlias);
            function->addParamAttr(i, llvm::Attribute::NoCapture);
        }
        for (unsigned i : {0u, block}) function->addParamAttr(i, llvm::Attribute::ReadOnly);
        return *function;
    }
    Value* place(llvm::IRBuilder<>& builder, Value* base, size_t offset)
    {
        return builder.CreateConstInBoundsGEP1_64(builder.getInt8Ty(), base, offset);
    }
    Value* result(const Output& output, const std::vector<Value*>& yields)
    {
        return output.yield ? yields[*output.yield] : llvm::ConstantFP::get(yields[0]->getType(), 1);
    }
    // To an array that may be absent.
    void store_lanes(llvm::IRBuilder<>& builder, Value* lanes, Value* array_place, Value* first, Value* is_there)
    {
        Value* array = builder.CreateLoad(pointer(), array_place);
        llvm::BasicBlock* wanted = llvm::BasicBlock::Create(context(), "wanted", builder.GetInsertBlock()->getParent());
        llvm::BasicBlock* next = llvm::BasicBlock::Create(context(), "next", builder.GetInsertBlock()->getParent());
        builder.CreateCondBr(builder.CreateIsNull(array), next, wanted);
        builder.SetInsertPoint(wanted);
        llvm::Type* element = lanes->getType()->getScalarType();
        ask_ahead(builder, element, array, first, module.lanes, true);
        builder.CreateMaskedStore(lanes, builder.CreateInBoundsGEP(element, array, first),
                                  llvm::Align(element->getPrimitiveSizeInBits() / 8), is_there);
        builder.CreateBr(next);
        builder.SetInsertPoint(next);
    }
};

} // namespace

uint32_t function_of(const EntryPoint& entry)
{
    const ir::Texture& texture = *entry.texture;
    return texture.height_gradient != UINT32_MAX ? texture.height_gradient : texture.height;
}

std::string symbol_of(const EntryPoint& entry)
{
    return "entry " + entry.name; // no identifier has a space
}

std::unique_ptr<llvm::Module> generate(const ir::Module& module, std::span<const EntryPoint> entries,
                                       const Processor& processor, llvm::LLVMContext& context, KernelCalls* kernels,
                                       bool is_draft)
{
    auto generated = std::make_unique<llvm::Module>("textures", context);
    std::map<std::pair<LaneForm, Precision>, ModuleEmitter> emitters;
    for (const EntryPoint& entry : entries) {
        const std::pair form{entry.lanes, entry.precision};
        ModuleEmitter& emitter =
            emitters.try_emplace(form, module, *generated, processor, entry.lanes, entry.precision, kernels, is_draft)
                .first->second;
        if (!kernels && entry.lanes == LaneForm::points) emitter.called_by_batches = worth_a_kernel(module);
        entry.lanes == LaneForm::points ? EntryEmitter(emitter, entry).batch()
                                        : EntryEmitter(emitter, entry).one_point();
    }
    for (auto& [form, emitter] : emitters) emitter.finish();
    if (kernels)
        kernels->note(*generated);
    else
        write_elementary(*generated);
    return generated;
}

} // namespace haptel::jit
