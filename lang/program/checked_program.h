// A program whose every name has a meaning: what the checker makes and lowering reads.
#pragma once

#include "lang/abi/outputs.h"
#include "lang/program/scope.h"
#include "lang/syntax/ast.h"

#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace haptel::lang {

struct CheckedLibrary;

// One file of the compilation as the parser left it, with the files whose names it sees; not transitive.
struct CheckFile {
    struct Imported {
        uint32_t file;
        std::string prefix; // of the names in it; empty: none
        bool operator==(const Imported&) const = default;
    };
    ast::File tree;
    std::vector<Imported> imported;
};

struct CheckedParameter {
    // Who sets it sets numbers: a vector is as many parameters as it has components.
    struct Component {
        double value = 0; // SI; int, uint and bool as numbers
        double minimum = -std::numeric_limits<double>::infinity();
        double maximum = std::numeric_limits<double>::infinity();
    };
    const Symbol* symbol = nullptr;
    const ast::TextureParameter* tree = nullptr;
    const Choices* choices = nullptr;  // null: it has none
    std::string unit;                  // SI: "m", "rad", "s", "Hz"; empty: a plain number
    std::vector<Component> components; // one, but for vectors
};

// "out float stiffness_scale": a variable of the body that has the table's value until the body assigns it.
struct CheckedOutput {
    const Symbol* symbol = nullptr;
    const OutputInfo* info = nullptr;
};

struct CheckedTexture {
    const ast::Texture* tree = nullptr;
    std::vector<CheckedParameter> parameters;
    std::vector<CheckedOutput> outputs; // by bit
    uint32_t slot_count = 0;            // local variables
    std::vector<FunctionInfo::Mention> mentions;
};

// Keeps the trees and everything they point to.
struct CheckedProgram {
    std::shared_ptr<const CheckedLibrary> library; // that all files see; null: none, or it is the library itself
    std::vector<CheckFile> files;                  // by Span::file; without those of the library
    std::deque<Symbol> symbols;
    std::deque<FunctionInfo> functions;
    std::deque<Choices> choices;
    std::deque<StructDeclaration> structs;
    std::vector<CheckedTexture> textures; // of file 0, in source order
};

} // namespace haptel::lang
