// One IR operation as LLVM instructions; apart from codegen.cpp because it is one long page.
#pragma once

#include "jit/codegen/llvm.h"
#include "lang/ir/ir.h"

namespace haptel::jit {

// On scalars, or on vectors of as many lanes; an image is the same for all lanes. `real`: double or float, as the reals
// among the operands are; the result is so too, but for sinturn and costurn, which give a float where `result` is one,
// by fused operations where `fuses`.
llvm::Value* emit_operation(llvm::IRBuilder<>& builder, ir::Op op, llvm::ArrayRef<llvm::Value*> operands,
                            llvm::Type* real, llvm::Type* result, bool fuses);

} // namespace haptel::jit
