#include "jit/codegen/kernels.h"

#include "jit/codegen/codegen_math.h"

#include <algorithm>

namespace haptel::jit {

namespace {

// Instructions with those of all calls: what is smaller costs more to call than to compile again.
constexpr size_t size_min = 60;

} // namespace

// Callees stand before their callers.
std::vector<bool> worth_a_kernel(const ir::Module& module)
{
    std::vector<size_t> sizes;
    std::vector<bool> are_library; // with all that they call
    std::vector<bool> worth;
    for (const ir::Function& function : module.functions) {
        size_t size = 0;
        bool is_library = function.is_library;
        ir::for_each_instruction(function.body, [&](const ir::Instruction& made) {
            ++size;
            const auto* call = std::get_if<ir::Call>(&made.kind);
            if (!call) return;
            size = std::min(size + sizes[call->function], size_min); // enough is enough
            is_library = is_library && are_library[call->function];
        });
        sizes.push_back(size);
        are_library.push_back(is_library);
        worth.push_back(is_library && size >= size_min);
    }
    return worth;
}

KernelCalls::KernelCalls(const ir::Module& of, const Processor& of_target, std::string named)
    : module(of)
    , processor(of_target)
    , target(std::move(named))
    , hashes(function_hashes(of))
    , is_worth_it(worth_a_kernel(of))
{
}

std::string KernelCalls::call(uint32_t function, const Signature& signature, LaneForm lanes, Precision precision)
{
    if (!is_worth_it[function]) return {};
    const std::string text = to_text(hashes[function]) + signature.text() + std::to_string(static_cast<int>(lanes)) +
                             ";" + std::to_string(static_cast<int>(precision)) + ";" + target;
    const std::string name = "haptel_k" + to_text(content_hash(text));
    functions.try_emplace(name, [=, &from = module, &of = processor](llvm::Module& alone, bool is_draft) {
        ModuleEmitter emitter(from, alone, of, lanes, precision, nullptr, is_draft);
        llvm::Function* const code = emitter.function(function, signature).code;
        code->setLinkage(llvm::GlobalValue::ExternalLinkage);
        code->setName(name);
        emitter.finish();
        write_elementary(alone);
    });
    return name;
}

void KernelCalls::note(const llvm::Module& made)
{
    functions.merge(elementary_calls(made));
}

} // namespace haptel::jit
