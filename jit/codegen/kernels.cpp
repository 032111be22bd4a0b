#include "jit/codegen/kernels.h"

#include <algorithm>

namespace haptel::jit {

namespace {

// Instructions with those of all calls: what is smaller costs more to call than to compile again.
constexpr size_t size_min = 60;

struct Extent {
    size_t size = 0;
    bool is_library = true; // it and all that it calls
};

} // namespace

// Callees stand before their callers.
std::vector<bool> worth_a_kernel(const ir::Module& module)
{
    std::vector<Extent> extents;
    std::vector<bool> worth;
    for (const ir::Function& function : module.functions) {
        Extent extent;
        extent.is_library = function.is_library;
        ir::for_each_instruction(function.body, [&](const ir::Instruction& made) {
            ++extent.size;
            const auto* call = std::get_if<ir::Call>(&made.kind);
            if (!call) return;
            extent.size = std::min(extent.size + extents[call->function].size, size_min); // enough is enough
            extent.is_library = extent.is_library && extents[call->function].is_library;
        });
        worth.push_back(extent.is_library && extent.size >= size_min);
        extents.push_back(extent);
    }
    return worth;
}

KernelCalls::KernelCalls(const ir::Module& module, std::string of_target)
    : target(std::move(of_target)), hashes(function_hashes(module)), is_worth_it(worth_a_kernel(module))
{
}

std::string KernelCalls::call(Kernel kernel)
{
    if (!is_worth_it[kernel.function]) return {};
    std::string text = to_text(hashes[kernel.function]) + kernel.signature.text();
    for (uint32_t number : {static_cast<uint32_t>(kernel.lanes), static_cast<uint32_t>(kernel.precision)})
        text += std::to_string(number) + ";";
    std::string name = "haptel_k" + to_text(content_hash(text + target));
    kernels.try_emplace(name, std::move(kernel));
    return name;
}

std::unique_ptr<llvm::Module> generate_kernel(const ir::Module& module, const std::string& name, const Kernel& kernel,
                                              const Processor& processor, llvm::LLVMContext& context, bool is_draft)
{
    auto generated = std::make_unique<llvm::Module>(name, context);
    ModuleEmitter emitter(module, *generated, processor, kernel.lanes, kernel.precision, nullptr, is_draft);
    llvm::Function* code = emitter.function(kernel.function, kernel.signature).code;
    code->setLinkage(llvm::GlobalValue::ExternalLinkage);
    code->setName(name);
    emitter.finish();
    write_elementary(*generated);
    return generated;
}

} // namespace haptel::jit
