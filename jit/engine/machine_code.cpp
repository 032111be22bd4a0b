#include "jit/engine/machine_code.h"

#include "jit/engine/optimise.h"
#include "jit/engine/stopwatch.h"

namespace haptel::jit {

std::string make_object(llvm::Module& module, llvm::TargetMachine& machine, Effort effort,
                        llvm::SmallVectorImpl<char>& object, CompileTimes& times)
{
    Stopwatch stopwatch;
    module.setDataLayout(machine.createDataLayout());
    module.setTargetTriple(machine.getTargetTriple().str());
    std::string problem;
    llvm::raw_string_ostream problems(problem);
    if (llvm::verifyModule(module, &problems)) return "generated code is malformed: " + problem;
    times.generate_s += stopwatch.lap_s();

    optimise(module, machine, effort);
    times.optimise_s += stopwatch.lap_s();

    llvm::raw_svector_ostream stream(object);
    llvm::legacy::PassManager passes;
    if (machine.addPassesToEmitFile(passes, stream, nullptr, llvm::CodeGenFileType::ObjectFile))
        return "the code generator cannot write object files for " + machine.getTargetTriple().str();
    passes.run(module);
    times.select_s += stopwatch.lap_s();
    return {};
}

} // namespace haptel::jit
