// The standard library's text, parsed and checked: once, for all programs that see it.
#pragma once

#include "lang/call_graph.h"
#include "lang/names.h"

#include <memory>
#include <vector>

namespace haptel::lang {

// Whole and never changed: any number of compilations read it at once.
struct CheckedLibrary {
    std::shared_ptr<const SourceSet> sources; // with indices from SourceSet::library_files on
    CheckedProgram program;
    Declarations declarations; // of all its files
    CallDepths depths;
    Diagnostics diagnostics; // what there is to say about it; told with every program
};

// Of these texts; null if there are none. The one that was asked for last is kept.
std::shared_ptr<const CheckedLibrary> checked_library(const std::vector<SourceFile>& texts);

} // namespace haptel::lang
