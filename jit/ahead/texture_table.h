// What a C program reads of a texture, as constants beside its code: its haptel_texture, and a block of its defaults.
#pragma once

#include "jit/codegen/codegen.h"
#include "lang/emit_c/library.h"

#include <array>
#include <span>

namespace llvm {
class Function;
class GlobalVariable;
class Module;
} // namespace llvm

namespace haptel::jit {

// The entries of a haptel_texture in their order there; null: absent.
using TableEntries = std::array<llvm::Function*, 4>;

// Of all that a module holds.
TableEntries table_entries(const llvm::Module& module, const ir::Texture& texture, std::span<const EntryPoint> entries);

// Under the names of lang/emit_c/library.h. Gives the table, which is constant unless its entries are chosen at load.
llvm::GlobalVariable* write_table(llvm::Module& module, const emit_c::LibraryTexture& texture,
                                  const TableEntries& entries, bool is_chosen_at_load);

} // namespace haptel::jit
