#include "tests/jit/engine/object.h"

#include "jit/codegen/isa.h"
#include "jit/codegen/llvm.h"
#include "jit/engine/machine_code.h"

#include <mutex>

namespace haptel::jit {

ObjectResult compile_object(const ir::Module& module, std::span<const EntryPoint> entries, const std::string& triple,
                            const std::string& processor)
{
    static std::once_flag once;
    std::call_once(once, [] {
        llvm::InitializeAllTargetInfos();
        llvm::InitializeAllTargets();
        llvm::InitializeAllTargetMCs();
        llvm::InitializeAllAsmPrinters();
    });
    std::string error;
    const llvm::Target* target = llvm::TargetRegistry::lookupTarget(triple, error);
    if (!target) return {{}, "LLVM has no code generator for " + triple + ": " + error};
    llvm::TargetOptions options;
    options.AllowFPOpFusion = llvm::FPOpFusion::Strict;
    const std::unique_ptr<llvm::TargetMachine> machine(
        target->createTargetMachine(triple, processor, "", options, llvm::Reloc::PIC_));
    if (!machine) return {{}, "LLVM has no code generator for a processor '" + processor + "' of " + triple};

    llvm::LLVMContext context;
    const Processor of_target = processor_of(*machine);
    const std::unique_ptr<llvm::Module> generated = generate(module, entries, of_target, context);
    CompileTimes unused;
    Object made = make_object(*generated, *machine, Effort::full, unused);
    return {std::move(made.bytes), std::move(made.error)};
}

} // namespace haptel::jit
