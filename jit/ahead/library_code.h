// The functions of code_library() (jit/codegen/codegen.h) that are Haptel's own, as code: what runs in no Haptel
// process finds them beside it. Those of the C library stay calls.
#pragma once

namespace llvm {
class Module;
}

namespace haptel::jit {

// Gives a body to each of them that the module declares, for itself alone.
void write_library(llvm::Module& module);

} // namespace haptel::jit
