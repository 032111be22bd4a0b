#include "jit/engine/machine_code.h"

#include <llvm/Passes/PassBuilder.h>
#include <llvm/Transforms/IPO/AlwaysInliner.h>
#include <llvm/Transforms/IPO/GlobalDCE.h>
#include <llvm/Transforms/IPO/ModuleInliner.h>
#include <llvm/Transforms/InstCombine/InstCombine.h>
#include <llvm/Transforms/Scalar/EarlyCSE.h>
#include <llvm/Transforms/Scalar/LICM.h>
#include <llvm/Transforms/Scalar/LoopPassManager.h>
#include <llvm/Transforms/Scalar/SimplifyCFG.h>

namespace haptel::jit {

namespace {

// A short draft does not wait for the inliner, which takes as long as all else: the calls that stay make it half as
// fast; a long one is compiled sooner with it.
constexpr unsigned short_draft = 2000; // instructions

llvm::ModulePassManager short_list(bool inlines)
{
    llvm::ModulePassManager passes;
    if (inlines) {
        passes.addPass(llvm::ModuleInlinerWrapperPass(llvm::getInlineParams(250)));
        passes.addPass(llvm::GlobalDCEPass());
    }
    llvm::FunctionPassManager in_function;
    in_function.addPass(llvm::SimplifyCFGPass());
    in_function.addPass(llvm::EarlyCSEPass());
    passes.addPass(llvm::createModuleToFunctionPassAdaptor(std::move(in_function)));
    return passes;
}

// What does not fit the registers goes to the stack, which callers align to 16 bytes: a vector of 64 would cross two
// lines of the cache in three processes of four, and a batch take half as long again.
void align_stack_of_wide_vectors(llvm::Module& module)
{
    for (llvm::Function& function : module) {
        uint64_t bytes = 0;
        for (const llvm::BasicBlock& block : function)
            for (const llvm::Instruction& made : block)
                if (const auto* vector = llvm::dyn_cast<llvm::FixedVectorType>(made.getType()))
                    bytes = std::max(bytes, vector->getPrimitiveSizeInBits().getFixedValue() / 8);
        if (bytes > 16)
            function.addFnAttr(
                llvm::Attribute::getWithStackAlignment(module.getContext(), llvm::Align(bytes > 32 ? 64 : 32)));
    }
}

void optimise(llvm::Module& module, llvm::TargetMachine& machine, Effort effort)
{
    llvm::LoopAnalysisManager loops;
    llvm::FunctionAnalysisManager functions;
    llvm::CGSCCAnalysisManager components;
    llvm::ModuleAnalysisManager modules;
    llvm::PassBuilder passes(&machine);
    passes.registerModuleAnalyses(modules);
    passes.registerCGSCCAnalyses(components);
    passes.registerFunctionAnalyses(functions);
    passes.registerLoopAnalyses(loops);
    passes.crossRegisterProxies(loops, functions, components, modules);
    const bool inlines = effort != Effort::draft || module.getInstructionCount() > short_draft;
    llvm::ModulePassManager list = effort != Effort::full
                                       ? short_list(inlines)
                                       : passes.buildPerModuleDefaultPipeline(llvm::OptimizationLevel::O2);
    list.run(module, modules);
    align_stack_of_wide_vectors(module);
}

} // namespace

Object make_object(llvm::Module& module, llvm::TargetMachine& machine, Effort effort, llvm::CodeGenFileType type)
{
    module.setDataLayout(machine.createDataLayout());
    module.setTargetTriple(machine.getTargetTriple().str());
    std::string problem;
    llvm::raw_string_ostream problems(problem);
    if (llvm::verifyModule(module, &problems)) return {{}, "generated code is malformed: " + problem};
    optimise(module, machine, effort);
    llvm::SmallVector<char, 0> object;
    llvm::raw_svector_ostream stream(object);
    llvm::legacy::PassManager passes;
    if (machine.addPassesToEmitFile(passes, stream, nullptr, type))
        return {{}, "the code generator cannot write code for " + machine.getTargetTriple().str()};
    passes.run(module);
    return {{object.begin(), object.end()}, {}, effort};
}

std::string Compilers::start(const llvm::orc::JITTargetMachineBuilder& host,
                             llvm::function_ref<void(llvm::TargetMachine&)> look)
{
    builder = host;
    auto machine = builder->setCodeGenOptLevel(llvm::CodeGenOptLevel::None).createTargetMachine();
    if (!machine)
        return "no code generator for " + builder->getTargetTriple().str() + " " + builder->getCPU() + ": " +
               llvm::toString(machine.takeError());
    look(**machine);
    give_back(Effort::draft, std::move(*machine));
    return {};
}

Object Compilers::make(llvm::Module& module, Effort effort)
{
    Machine machine = take(effort);
    Object object = make_object(module, *machine, effort);
    give_back(effort, std::move(machine));
    return object;
}

Compilers::Machine Compilers::take(Effort effort)
{
    const std::lock_guard lock(mutex);
    std::vector<Machine>& of_effort = idle[static_cast<size_t>(effort)];
    if (!of_effort.empty()) {
        Machine machine = std::move(of_effort.back());
        of_effort.pop_back();
        return machine;
    }
    constexpr llvm::CodeGenOptLevel levels[] = {llvm::CodeGenOptLevel::None, llvm::CodeGenOptLevel::Less,
                                                llvm::CodeGenOptLevel::Default};
    builder->setCodeGenOptLevel(levels[static_cast<size_t>(effort)]);
    return llvm::cantFail(builder->createTargetMachine()); // as start() could
}

void Compilers::give_back(Effort effort, Machine machine)
{
    const std::lock_guard lock(mutex);
    idle[static_cast<size_t>(effort)].push_back(std::move(machine));
}

} // namespace haptel::jit
