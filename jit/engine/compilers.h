// LLVM IR to object files, for as many threads at once as ask.
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
    bool is_from_disk = false;
};

class Compilers {
public:
    // For this processor. Nothing or why not; nothing else may be called before.
    std::string start(const llvm::orc::JITTargetMachineBuilder& host);

    Object make(llvm::Module& module, Effort effort, CompileTimes& times);

    // Calls `look` with a code generator of this processor.
    template <class Look>
    void with_machine(const Look& look)
    {
        std::string unused;
        const Lease lease(*this, Effort::draft, unused);
        look(*lease.machine);
    }

private:
    // A code generator serves one thread at a time; it is made when all there are serve another.
    struct Lease {
        Lease(Compilers& owner, Effort effort, std::string& error); // no machine: see error
        ~Lease();
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
        Compilers& compilers;
        const Effort effort;
        std::unique_ptr<llvm::TargetMachine> machine;
    };

    std::optional<llvm::orc::JITTargetMachineBuilder> builder;
    std::mutex mutex;
    std::array<std::vector<std::unique_ptr<llvm::TargetMachine>>, 3> idle; // by Effort
};

} // namespace haptel::jit
