// Elementary functions in generated code: the templates of lang/ir/elementary_*.h over instructions.
//
// Each is one LLVM function by form (f64, f32 or f32 of an angle in f64; one point or lanes), of some 60 to 200
// instructions: in 16 lanes of f64 as much to compile as a small texture. So a program only declares what it calls, and
// the engine compiles that once for all programs, as kernels; what must be complete by itself has them written in.
#pragma once

#include "jit/codegen/llvm.h"
#include "lang/ir/ir.h"

#include <map>
#include <memory>
#include <span>
#include <string>

namespace haptel::jit {

// For ir::is_elementary(op). Operands are doubles or floats, or vectors of as many lanes; the result is as they are,
// but a float where `result` is one and the operand of sin, cos or tan a double.
llvm::Value* call_elementary(llvm::IRBuilder<>& builder, ir::Op op, std::span<llvm::Value* const> operands,
                             llvm::Type* result);

struct ElementaryForm {
    ir::Op op{};
    bool is_single = false; // the operands
    bool narrows = false;   // an angle in f64 to f32
    uint32_t lanes = 1;
};
using ElementaryForms = std::map<std::string, ElementaryForm>; // by symbol

// Those that a module declares and does not hold.
ElementaryForms elementary_calls(const llvm::Module& module);
// Writes them into the module, for itself alone.
void write_elementary(llvm::Module& module);
// A module with one of them, under its symbol.
std::unique_ptr<llvm::Module> generate_elementary(const std::string& symbol, const ElementaryForm& form,
                                                  llvm::LLVMContext& context);

} // namespace haptel::jit
