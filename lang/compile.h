// Front door of the language: text to checked, differentiated, verified IR, and everything there is to say about the
// text.
//
// Performs no I/O: the standard library's text comes as an argument and imports through a callback. Never throws,
// prints, recurses without bound or loops without end, whatever the bytes.
#pragma once

#include "lang/ir/ir.h"
#include "lang/text/diagnostic.h"
#include "lang/text/source.h"

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

namespace haptel::lang {

// An imported file; or nothing, then perhaps why ("it is a pipe") and what to do.
struct Imported {
    std::optional<SourceFile> file;
    std::string why, hint;
    Imported(std::optional<SourceFile> found, std::string reason = {}, std::string help = {})
        : file(std::move(found)), why(std::move(reason)), hint(std::move(help))
    {
    }
};

// `path` as written, "wood/oak.haptel", or "wood.oak" for a file of a library (lang/abi/library_name.h); `importer` the
// name of the file that asks.
using ImportLoader = std::function<Imported(std::string_view path, std::string_view importer)>;

struct CompileOptions {
    std::vector<SourceFile> library; // visible everywhere without import; normally stdlib's
    ImportLoader load_import;        // empty: imports are errors
    std::string_view only_texture;   // compile entries of this texture alone; empty: of all in the main file
    bool strict = false;             // warnings are errors
};

struct Program {
    SourceSet sources;
    ir::Module module; // verified; textures of the main file only, in source order
};

struct CompileResult {
    std::shared_ptr<const Program> program; // null if there was an error
    Diagnostics diagnostics;                // sorted by place
    SourceSet sources;                      // for rendering; also of a program that failed
    std::vector<std::string> files;         // main file, then imports: what a watcher must watch
};

CompileResult compile(SourceFile main, const CompileOptions& options);

} // namespace haptel::lang
