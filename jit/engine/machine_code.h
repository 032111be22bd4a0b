// An LLVM module to an object file.
#pragma once

#include "jit/codegen/llvm.h"
#include "jit/engine/engine.h"

namespace haptel::jit {

// Verifies, optimises and selects; adds what that took to `times`. Nothing or why not.
std::string make_object(llvm::Module& module, llvm::TargetMachine& machine, Effort effort,
                        llvm::SmallVectorImpl<char>& object, CompileTimes& times);

} // namespace haptel::jit
