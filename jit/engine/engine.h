// Machine code in this process, freed with the program that it is of; kernels (jit/codegen/kernels.h) stay. What took
// long to make is kept on disk (jit/engine/object_cache.h).
//
// Code may call the functions of code_library() and kernels, and nothing else of the process. It is compiled for the
// host's processor, every feature of it that the environment's HAPTEL_ISA leaves (jit/codegen/isa.h). What LLVM does to
// it changes no bit: it is the same whatever the effort, with kernels or without. Any thread may compile: efforts do
// not wait for each other. Running needs no lock.
#pragma once

#include "jit/codegen/codegen.h"
#include "lang/abi/abi.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

namespace haptel::jit {

// Time spent against speed of the code; never a difference in any bit of a result.
enum class Effort : uint8_t {
    draft, // callable at once, at half the speed: for who replaces it soon (CompiledProgram::optimise)
    quick, // callable soon; calls kernels as a draft does, which costs some nanoseconds a call
    full   // all of LLVM's -O2 over the program with all that it calls: what a long exploration deserves
};

// Owns the machine code of one program.
class Code {
public:
    // Its entry points by name.
    struct Entry {
        void* address = nullptr;
        void** slot = nullptr; // holds where the entry jumps to; none in code of full effort
        bool is_batch = false;
    };
    Code(std::map<std::string, Entry> linked, std::shared_ptr<void> owned, bool is_full)
        : entries(std::move(linked)), memory(std::move(owned)), is_final(is_full)
    {
    }
    // Of an entry point by its name; null if there is none.
    haptel_entry* entry(const std::string& name) const;
    haptel_batch_entry* batch_entry(const std::string& name) const;

    // True where the code is of full effort, made so or replaced.
    bool is_full() const { return is_final; }
    // From now on the entries of this code, of less than full effort, run those of `better`, of the same program:
    // callers in any thread go on and hold the pointers that they held. Once.
    void replace_by(std::shared_ptr<const Code> better) const;

private:
    const std::map<std::string, Entry> entries;
    const std::shared_ptr<void> memory;
    mutable std::atomic<bool> is_final;
    mutable std::mutex replacing;
    mutable std::shared_ptr<const Code> replacement;
};

struct CodeResult {
    std::shared_ptr<const Code> code;
    std::string error; // names the stage that failed; empty if there is code
};

struct CodeOptions {
    Effort effort = Effort::quick;
    bool kernels = true; // false: code of less than full effort, too, holds everything that it calls
};

// `module` must be verified.
CodeResult compile_code(const ir::Module& module, std::span<const EntryPoint> entries, const CodeOptions& options = {});

// Makes quick code of the kernels that a draft of such a program calls, in memory and on disk, where there are drafts
// or none.
void prepare_kernels(const ir::Module& module, std::span<const EntryPoint> entries);

// Programs whose code is in memory now.
size_t programs_alive();

// Library functions that were compiled apart and are in memory (jit/codegen/kernels.h); they stay.
size_t kernels_alive();

struct EngineInfo {
    uint32_t batch_lanes = 0; // points that a batch entry evaluates side by side
    std::string isa;          // "avx512 vbmi", as jit/codegen/isa.h names it. Empty where there is no engine
    std::string name;         // "LLVM 19.1.7 x86_64-pc-linux-gnu skylake-avx512": for reports
    // What decides which code is made of an IR, and code on disk is known by: code generator, LLVM, processor.
    std::string identity;
};
const EngineInfo& engine_info();

} // namespace haptel::jit
