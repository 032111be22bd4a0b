// Entries that can be given other code while they are in use: each jumps to where its slot points. Whoever calls it
// holds the same pointer before and after, and gets the same bits if the code is of the same program.
#pragma once

#include "jit/codegen/codegen.h"
#include "jit/codegen/llvm.h"

#include <string>

namespace haptel::jit {

// The symbol of an entry's slot, which holds the address of its code.
std::string slot_of(const EntryPoint& entry);

void make_replaceable(llvm::Module& module, std::span<const EntryPoint> entries);

} // namespace haptel::jit
