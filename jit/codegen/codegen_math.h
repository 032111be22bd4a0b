// Elementary functions in generated code: the templates of lang/math/elementary_*.h over instructions.
//
// Each is one LLVM function by form (f64, f32 or f32 of an angle in f64; one point or lanes), of some 60 to 200
// instructions: in 16 lanes of f64 as much to compile as a small texture. So a program only declares what it calls, and
// the engine compiles that once for all programs, as kernels; what must be complete by itself has them written in.
#pragma once

#include "jit/codegen/kernels.h"
#include "jit/codegen/llvm.h"
#include "lang/ir/ir.h"

namespace haptel::jit {

// For ir::is_elementary(op). Operands are doubles or floats, or vectors of as many lanes; the result is as they are,
// but a float where `result` is one and the operand of sin, cos or tan a double.
llvm::Value* call_elementary(llvm::IRBuilder<>& builder, ir::Op op, llvm::ArrayRef<llvm::Value*> operands,
                             llvm::Type* result);

// sinturn or costurn, once the whole turns are taken off, as TurnParts of lang/ir/semantics.h has it, in place. `way`:
// to the nearest whole turn, -1/2 .. 1/2; scalars or vectors. The result's elements are of type `result`, float or
// double, and so are the operations; those on floats are fused where `fuses`.
llvm::Value* emit_turn(llvm::IRBuilder<>& builder, ir::Op op, llvm::Value* way, llvm::Type* result, bool fuses);

// Any other operation, in instructions (jit/codegen/codegen_operation.cpp): on scalars, or on vectors of as many lanes.
// `real`: double or float, as the reals among the operands are; the result is so
// too, but for sinturn and costurn, which give a float where `result` is one, by fused operations where `fuses`.
llvm::Value* emit_operation(llvm::IRBuilder<>& builder, ir::Op op, llvm::ArrayRef<llvm::Value*> operands,
                            llvm::Type* real, llvm::Type* result, bool fuses);

// Those that a module declares and does not hold, for what is compiled apart.
FunctionsApart elementary_calls(const llvm::Module& module);
// Writes them into the module, for itself alone.
void write_elementary(llvm::Module& module);

} // namespace haptel::jit
