// Object code for a processor that need not be this one: what a program is on the machine it is shipped to.
#pragma once

#include "jit/codegen/codegen.h"

#include <string>

namespace haptel::jit {

struct ObjectResult {
    std::string object; // an object file of the target's format; empty: see error
    std::string error;
};

// `module` must be verified. `triple` and `processor` as LLVM names them: "aarch64-linux-gnu", "generic". What the
// object leaves undefined are functions of code_library().
ObjectResult compile_object(const ir::Module& module, std::span<const EntryPoint> entries, const std::string& triple,
                            const std::string& processor);

} // namespace haptel::jit
