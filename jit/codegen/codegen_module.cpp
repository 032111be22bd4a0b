#include "jit/codegen/codegen_module.h"

#include "jit/codegen/codegen_function.h"
#include "jit/codegen/kernels.h"

#include <algorithm>

namespace haptel::jit {

namespace {

bool any(const std::vector<bool>& flags)
{
    return std::find(flags.begin(), flags.end(), true) != flags.end();
}

// A loop that is not split, and all of whose sums are f64.
bool can_be_ordered(const ValueForms& forms, const ir::For& loop, const LaneLoop& in_lanes)
{
    bool can = in_lanes.waits.empty();
    for (size_t i = 0; i < in_lanes.carried.size(); ++i)
        can =
            can && !(in_lanes.carried[i].kind == Carried::Kind::sum && forms.is_single(loop.body[0].parameters[i + 1]));
    return can;
}

} // namespace

llvm::Value* at_offset(llvm::IRBuilder<>& builder, llvm::Value* base, size_t offset)
{
    return builder.CreateConstInBoundsGEP1_64(builder.getInt8Ty(), base, offset);
}

// Beyond the array's end nothing is fetched, and nothing is wrong.
void ask_ahead(llvm::IRBuilder<>& builder, llvm::Type* element, llvm::Value* array, llvm::Value* first, uint32_t lanes,
               bool to_write)
{
    constexpr uint32_t line_bytes = 64;
    const uint32_t per_line = line_bytes * 8 / element->getScalarSizeInBits();
    for (uint32_t lane = 0; lane < lanes; lane += per_line) {
        llvm::Value* index = builder.CreateAdd(first, builder.getInt64(points_ahead + lane));
        builder.CreateIntrinsic(llvm::Intrinsic::prefetch, {array->getType()},
                                {builder.CreateGEP(element, array, index), builder.getInt32(to_write ? 1 : 0),
                                 builder.getInt32(3), builder.getInt32(1)});
    }
}

llvm::Type* ModuleEmitter::type(ir::Type type, Form held)
{
    llvm::LLVMContext& context = target.getContext();
    const auto lanes_of = [&](llvm::Type* scalar) -> llvm::Type* {
        return held.in_lanes ? llvm::FixedVectorType::get(scalar, lanes) : scalar;
    };
    switch (type) {
    case ir::Type::real:
        return lanes_of(held.is_single ? llvm::Type::getFloatTy(context) : llvm::Type::getDoubleTy(context));
    case ir::Type::i32:
    case ir::Type::u32: return lanes_of(llvm::Type::getInt32Ty(context));
    case ir::Type::boolean: return lanes_of(llvm::Type::getInt1Ty(context));
    case ir::Type::image: return lanes_of(llvm::PointerType::getUnqual(context));
    }
    return nullptr;
}

ValueForms ModuleEmitter::forms(uint32_t index, const Signature& signature)
{
    const ir::Function& from = source.functions[index];
    ValueForms made{.function = from,
                    .varies = varying_values(from, signature.arguments),
                    .wide = plan.wide_values(index, signature.wide_results)};
    if (!signature.needed_results.empty()) made.needed = needs.of(index, signature.needed_results);
    if (form == LaneForm::points) {
        made.in_lanes = made.varies;
        return made;
    }
    if (form == LaneForm::iterations && !any(signature.in_lanes) && !any(signature.in_order))
        made.loops = lane_loops(from, made.varies);
    for (auto& [loop, in_lanes] : made.loops) in_lanes.is_ordered = is_draft && can_be_ordered(made, *loop, in_lanes);
    made.in_lanes = varying_iterations(from, signature.in_lanes, made.loops, false);
    made.in_order = varying_iterations(from, signature.in_order, made.loops, true);
    return made;
}

std::string Signature::text() const
{
    static_assert(sizeof(Signature) == 5 * sizeof(std::vector<bool>), "what a signature gains belongs into its text");
    std::string bits;
    for (const std::vector<bool>* flags : {&arguments, &in_lanes, &wide_results, &in_order, &needed_results}) {
        for (bool flag : *flags) bits += flag ? '1' : '0';
        bits += ';';
    }
    return bits;
}

const ModuleEmitter::Function& ModuleEmitter::function(uint32_t index, const Signature& signature)
{
    Function& made = functions[{index, signature}];
    if (made.code) return made;
    const ir::Function& from = source.functions[index];
    made.forms = std::make_shared<const ValueForms>(forms(index, signature));
    std::vector<llvm::Type*> parameters, results;
    for (ir::Value parameter : from.parameters)
        parameters.push_back(type(from.type(parameter), (*made.forms)[parameter]));
    for (size_t i = 0; i < from.body.yields.size(); ++i) { // they vary together
        const ir::Type yielded = from.type(from.body.yields[i]);
        const bool is_wide = yielded != ir::Type::real || !any(signature.arguments) || signature.wide_results[i];
        made.results.push_back({any(signature.in_lanes), !is_wide});
        results.push_back(type(yielded, made.results[i]));
    }
    llvm::Type* returned = results.size() == 1 ? results[0] : llvm::StructType::get(target.getContext(), results);
    made.code = llvm::Function::Create(llvm::FunctionType::get(returned, parameters, false),
                                       llvm::GlobalValue::InternalLinkage, from.name, target);
    made.code->setCallingConv(llvm::CallingConv::Fast);
    made.code->setDoesNotThrow();
    const bool reads_images = std::any_of(from.parameters.begin(), from.parameters.end(),
                                          [&](ir::Value value) { return from.type(value) == ir::Type::image; });
    reads_images ? made.code->setOnlyReadsMemory() : made.code->setDoesNotAccessMemory();
    made.code->setWillReturn();
    const std::string kernel = kernels ? kernels->call(index, signature, form, plan.precision) : "";
    if (kernel.empty()) {
        unfinished.push_back(&made);
    } else {
        made.code->setLinkage(llvm::GlobalValue::ExternalLinkage);
        made.code->setName(kernel);
    }
    return made;
}

// A list, not a recursion: functions may call each other in long chains.
void ModuleEmitter::finish()
{
    while (!unfinished.empty()) {
        const auto& [code, forms, results] = *unfinished.back();
        unfinished.pop_back();
        llvm::IRBuilder<> builder(llvm::BasicBlock::Create(target.getContext(), "", code));
        FunctionEmitter emitter(*this, builder, *forms);
        for (unsigned i = 0; i < code->arg_size(); ++i) emitter.define(forms->function.parameters[i], code->getArg(i));
        const Values yields = emitter.body(results);
        if (yields.size() == 1)
            builder.CreateRet(yields[0]);
        else
            builder.CreateAggregateRet(yields.data(), static_cast<unsigned>(yields.size()));
    }
}

} // namespace haptel::jit
