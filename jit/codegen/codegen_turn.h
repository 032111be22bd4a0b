// sin and cos of turns, once the whole turns are taken off: TurnParts of lang/ir/semantics.h as code.
#pragma once

#include "jit/codegen/llvm.h"

namespace haptel::jit {

// `way`: to the nearest whole turn, -1/2 .. 1/2; scalars or vectors. The result's elements are of type `result`, float
// or double, and so are the operations; those on floats are fused where `fuses`.
llvm::Value* sine_of_turns(llvm::IRBuilder<>& builder, llvm::Value* way, llvm::Type* result, bool fuses);
llvm::Value* cosine_of_turns(llvm::IRBuilder<>& builder, llvm::Value* way, llvm::Type* result, bool fuses);

} // namespace haptel::jit
