// IR to LLVM IR, one point at a time or many, in one of three precisions.
//
// In f64 every operation means what lang/ir/semantics.h says, bit for bit: no fast-math flags, no contraction,
// elementary functions by the templates of lang/ir/elementary_*.h. Iterations in lanes alone may add in another order.
// In mixed and f32, what varies is fused where the processor can: a product that a sum or difference takes is not
// rounded by itself.
//
// The height alone is made from the function that has the gradient too: what of it the height needs, in the forms that
// it has there. Precision, fusing and lanes are decided once, so that a height with and without its gradient has the
// same bits.
//
// Functions that an entry reaches become internal LLVM functions; tables become constant globals. The module must be
// verified (lang/ir/verify.h): table indices and trip counts are trusted here.
#pragma once

#include "jit/codegen/precision.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace llvm {
class LLVMContext;
class Module;
} // namespace llvm

namespace haptel::jit {

// A C function that generated code may call. There are no others: the whole list is code_library().
struct LibraryFunction {
    const char* name; // in generated code
    void* address;
};
std::span<const LibraryFunction> code_library();

// What code may be written for.
struct Processor {
    uint32_t lanes = 4;          // points that a batch evaluates at once
    bool permutes_words = false; // AVX-512F: dynamic permutation of two registers of 32- and 64-bit words
    bool permutes_bytes = false; // AVX-512VBMI: of bytes
    bool fuses = false;          // FMA: a * b + c as one instruction, rounded once
};

// What the lanes of a register hold.
enum class LaneForm : uint8_t {
    one,        // nothing: one point, one iteration after the other
    iterations, // iterations of one loop for one point, where a loop allows it (jit/codegen/iteration_lanes.h)
    points,     // points: a batch
};

// A batch asks for memory ahead of the lanes that it works on: what is not near yet arrives meanwhile.
constexpr uint32_t points_ahead = 128;

// One entry point to be emitted: a haptel_entry, or for points in lanes a haptel_batch_entry. The name is any text; it
// tells the entries of one program apart.
struct EntryPoint {
    enum class Kind : uint8_t { height, height_gradient };
    std::string name;
    const ir::Texture* texture;
    Kind kind;
    LaneForm lanes = LaneForm::one;
    Precision precision = Precision::f64;
};

// The function that an entry is made from, of which the height alone leaves out what it does not need.
uint32_t function_of(const EntryPoint& entry);

// What an entry is called in an object, where its name stands beside those of code_library(), of kernels and of
// whatever the linker knows: no name that an author can give is one of them.
std::string symbol_of(const EntryPoint& entry);

class KernelCalls;

// Data layout and triple are the caller's to set before optimisation. With `kernels`, what is worth a kernel is
// declared and called (jit/codegen/kernels.h); without, the module is complete but for code_library(). A draft is quick
// to compile and has the same bits.
std::unique_ptr<llvm::Module> generate(const ir::Module& module, std::span<const EntryPoint> entries,
                                       const Processor& processor, llvm::LLVMContext& context,
                                       KernelCalls* kernels = nullptr, bool is_draft = false);

} // namespace haptel::jit
