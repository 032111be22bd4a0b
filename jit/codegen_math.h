// Elementary functions in generated code: the templates of lang/ir/elementary_*.h over instructions.
//
// Each function that a module calls is one internal LLVM function in it, by form: f64, f32 or f32 of an angle in f64;
// one point or lanes. It is written when it is first called, some 60 to 200 instructions.
#pragma once

#include "jit/llvm.h"
#include "lang/ir/ir.h"

#include <span>

namespace haptel::jit {

// For ir::is_elementary(op). Operands are doubles or floats, or vectors of as many lanes; the result is as they are,
// but a float where `result` is one and the operand of sin, cos or tan a double.
llvm::Value* call_elementary(llvm::IRBuilder<>& builder, ir::Op op, std::span<llvm::Value* const> operands,
                             llvm::Type* result);

} // namespace haptel::jit
