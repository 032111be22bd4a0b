// Textures to machine code for programs without LLVM, and for other processors than this one.
//
// The code is that of jit/engine with full effort, made by the same steps: on one instruction set it has the bits of
// code that is made at run time. Beside it stands what a C program needs (lang/emit_c/header.h): tables, defaults, and
// all that the code calls but the C library's floor, ceil, trunc, roundeven, fma (also of float), memcpy and memset.
// Equal textures give equal bytes.
#pragma once

#include "jit/codegen/precision.h"
#include "lang/emit_c/library.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptel::jit {

struct AheadOptions {
    // As machine_with_isa() of jit/codegen/isa.h names them. Of several the largest that the processor has is chosen
    // when the code is loaded; the least runs where none of the others fits.
    std::vector<std::string> isas = {"baseline"};
    std::optional<Precision> precision = {}; // none: f64 for one point, mixed for many
};

struct AheadResult {
    std::string bytes, error; // one of them is empty
};

// A relocatable object (ELF), for static and shared libraries; its symbols are those of the header.
AheadResult build_object(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options = {});

// The same before code is selected: LLVM's intermediate representation as text.
AheadResult build_llvm_text(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options = {});

// The same object as assembler's text.
AheadResult build_assembler_text(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options = {});

// A static library that holds this object under that name.
AheadResult archive_of(const std::string& object, const std::string& name);

} // namespace haptel::jit
