// Constant tables read by all lanes at once.
#pragma once

#include "jit/codegen/codegen_module.h"

namespace haptel::jit {

// The cells of that table at `index` (a vector of i32, each in range), reals in f32 where `is_single`. A small table
// stays in registers and is permuted where the processor can; any other is gathered from memory.
llvm::Value* read_in_lanes(ModuleEmitter& module, llvm::IRBuilder<>& builder, uint32_t table, llvm::Value* index,
                           bool is_single);

} // namespace haptel::jit
