// What a C program reads of a texture, as constants beside its code: its haptel_texture, and a block of its defaults.
#pragma once

#include "jit/codegen/codegen.h"
#include "lang/emit_c/library.h"

#include <span>

namespace haptel::jit {

// Under the names of lang/emit_c/library.h. `entries`: of the module that holds their functions.
void write_table(llvm::Module& module, const emit_c::LibraryTexture& texture, std::span<const EntryPoint> entries);

} // namespace haptel::jit
