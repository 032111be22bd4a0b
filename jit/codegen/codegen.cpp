#include "jit/codegen/codegen.h"

#include "jit/codegen/codegen_function.h"
#include "jit/codegen/codegen_math.h"
#include "jit/codegen/kernels.h"
#include "lang/abi/outputs.h"

#include <cstddef>
#include <optional>

namespace haptel::jit {

namespace {

using llvm::Value;

// A number of the sample: where it stands in haptel_sample and in haptel_samples, and which result of the entry it is.
struct Output {
    size_t offset, array_offset;
    std::optional<size_t> yield; // none: `value`
    double value = 1;
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
    size_t next = 5;
    for (const OutputInfo& info : output_table) {
        const bool is_written = entry.texture->writes & info.writes;
        if (!is_written && !(info.writes & outputs_always_written)) continue;
        for (size_t i = 0; i < info.components; ++i)
            outputs.push_back({info.offset + i * sizeof(double), info.array_offset + i * sizeof(double*),
                               is_written ? std::optional(next++) : std::nullopt, info.value});
    }
    return outputs;
}

ValueForms forms_of(ModuleEmitter& module, const EntryPoint& entry, const std::vector<Output>& outputs)
{
    const size_t count = module.source.functions[function_of(entry)].body.yields.size();
    Signature signature;
    signature.wide_results.resize(count);
    if (entry.kind == EntryPoint::Kind::height) {
        signature.needed_results.resize(count);
        for (const Output& output : outputs) signature.needed_results[*output.yield] = true;
    }
    return module.forms(function_of(entry), signature);
}

// A haptel_entry, or a haptel_batch_entry; the last argument is what is written.
llvm::Function& declare(llvm::Module& module, const EntryPoint& entry)
{
    llvm::LLVMContext& context = module.getContext();
    std::vector<llvm::Type*> arguments(3, llvm::PointerType::getUnqual(context));
    if (entry.lanes == LaneForm::points) arguments.insert(arguments.begin() + 1, llvm::Type::getInt64Ty(context));
    auto* const function =
        llvm::Function::Create(llvm::FunctionType::get(llvm::Type::getVoidTy(context), arguments, false),
                               llvm::GlobalValue::ExternalLinkage, symbol_of(entry), module);
    function->setDoesNotThrow();
    for (llvm::Argument& argument : function->args()) {
        if (!argument.getType()->isPointerTy()) continue;
        argument.addAttr(llvm::Attribute::NoAlias);
        argument.addAttr(llvm::Attribute::NoCapture);
        if (argument.getArgNo() + 1 < arguments.size()) argument.addAttr(llvm::Attribute::ReadOnly);
    }
    return *function;
}

// To an array that may be absent.
void store_lanes(llvm::IRBuilder<>& builder, Value* values, Value* array_place, Value* first, Value* is_there)
{
    const uint32_t lanes = llvm::cast<llvm::FixedVectorType>(values->getType())->getNumElements();
    llvm::Function* const function = builder.GetInsertBlock()->getParent();
    Value* const array = builder.CreateLoad(builder.getPtrTy(), array_place);
    llvm::BasicBlock* const wanted = llvm::BasicBlock::Create(builder.getContext(), "wanted", function);
    llvm::BasicBlock* const next = llvm::BasicBlock::Create(builder.getContext(), "next", function);
    builder.CreateCondBr(builder.CreateIsNull(array), next, wanted);
    builder.SetInsertPoint(wanted);
    llvm::Type* const element = values->getType()->getScalarType();
    ask_ahead(builder, element, array, first, lanes, true);
    builder.CreateMaskedStore(values, builder.CreateInBoundsGEP(element, array, first),
                              llvm::Align(element->getPrimitiveSizeInBits() / 8), is_there);
    builder.CreateBr(next);
    builder.SetInsertPoint(next);
}

// One point; or a loop over groups of lanes, the last of which may be short.
void write_entry(ModuleEmitter& module, const EntryPoint& entry)
{
    const bool is_batch = entry.lanes == LaneForm::points;
    const ir::Function& source = module.source.functions[function_of(entry)];
    const std::vector<Output> outputs = outputs_of(entry, source.body.yields.size() - 1);
    const ValueForms forms = forms_of(module, entry, outputs);
    llvm::Function& function = declare(module.target, entry);
    llvm::Argument *const points = function.getArg(0), *const samples = function.arg_end() - 1,
                          *const block = samples - 1;
    llvm::IRBuilder<> builder(llvm::BasicBlock::Create(function.getContext(), "", &function));

    const auto write = [&](Value* first, Value* is_there) {
        FunctionEmitter emitter(module, builder, forms, {points, block, entry.texture, first, is_there});
        const Values yields = emitter.body(std::vector<Form>(source.body.yields.size(), {.in_lanes = is_batch}));
        for (const Output& output : outputs) {
            Value* const result =
                output.yield ? yields[*output.yield] : llvm::ConstantFP::get(yields[0]->getType(), output.value);
            if (is_batch)
                store_lanes(builder, result, at_offset(builder, samples, output.array_offset), first, is_there);
            else
                builder.CreateStore(result, at_offset(builder, samples, output.offset));
        }
    };
    const auto write_group = [&](Value* first, const Values&) {
        llvm::Type* const indices = llvm::FixedVectorType::get(builder.getInt64Ty(), module.lanes);
        Value* const index =
            builder.CreateAdd(builder.CreateVectorSplat(module.lanes, first), builder.CreateStepVector(indices));
        Value* const count = builder.CreateVectorSplat(module.lanes, function.getArg(1));
        write(first, builder.CreateICmpULT(index, count));
        return Values{};
    };
    if (is_batch)
        repeat(builder, function.getArg(1), module.lanes, {}, write_group);
    else
        write(nullptr, nullptr);
    builder.CreateRetVoid();
}

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
        write_entry(emitter, entry);
    }
    for (auto& [form, emitter] : emitters) emitter.finish();
    if (kernels)
        kernels->note(*generated);
    else
        write_elementary(*generated);
    return generated;
}

} // namespace haptel::jit
