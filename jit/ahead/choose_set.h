// Several instruction sets in one library: the processor is asked once, when the program or the library is loaded.
#pragma once

#include "jit/ahead/texture_table.h"

#include <string>
#include <vector>

namespace haptel::jit {

// What tables get where a processor has the set, and the system has enabled its registers.
struct SetOfEntries {
    std::string isa;                   // avx2 or avx512
    std::vector<TableEntries> entries; // one for each table
};

// Writes a constructor that puts the entries of the last of `sets` that fits into `tables`; none: they stay as they
// are. It runs before those of the program it is linked into, and calls nothing.
void choose_at_load(llvm::Module& module, const std::vector<llvm::GlobalVariable*>& tables,
                    const std::vector<SetOfEntries>& sets);

} // namespace haptel::jit
