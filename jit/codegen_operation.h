// One IR operation as LLVM instructions; apart from codegen.cpp because it is one long page.
#pragma once

#include "jit/llvm.h"
#include "lang/ir/ir.h"

#include <span>

namespace haptel::jit {

llvm::Value* emit_operation(llvm::IRBuilder<>& builder, ir::Op op, std::span<llvm::Value* const> operands);

} // namespace haptel::jit
