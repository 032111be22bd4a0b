// LLVM's passes over generated code: a short list for drafts and quick code, the standard pipeline for full effort.
#pragma once

#include "jit/codegen/llvm.h"
#include "jit/engine/engine.h"

namespace haptel::jit {

void optimise(llvm::Module& module, llvm::TargetMachine& machine, Effort effort);

} // namespace haptel::jit
