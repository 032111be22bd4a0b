// LLVM modules to object files, for as many threads at once as ask: by a short list of LLVM's passes for drafts and
// quick code, by the standard pipeline for full effort.
#pragma once

#include "jit/codegen/llvm.h"
#include "jit/engine/engine.h"

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace haptel::jit {

// An object file and how it came about.
struct Object {
    std::string bytes, error;
    Effort effort = Effort::quick; // what went into it, at least what was asked for
};

// Verifies, optimises and selects. `type`: assembler's text instead.
Object make_object(llvm::Module& module, llvm::TargetMachine& machine, Effort effort,
                   llvm::CodeGenFileType type = llvm::CodeGenFileType::ObjectFile);

// The code generators of this processor. One serves one thread at a time; it is made when all there are serve another.
class Compilers {
public:
    // Calls `look` with one. Nothing or why not; nothing else may be called before.
    std::string start(const llvm::orc::JITTargetMachineBuilder& host,
                      llvm::function_ref<void(llvm::TargetMachine&)> look);

    Object make(llvm::Module& module, Effort effort);

private:
    using Machine = std::unique_ptr<llvm::TargetMachine>;
    Machine take(Effort effort);
    void give_back(Effort effort, Machine machine);

    std::optional<llvm::orc::JITTargetMachineBuilder> builder;
    std::mutex mutex;
    std::array<std::vector<Machine>, 3> idle; // by Effort
};

} // namespace haptel::jit
