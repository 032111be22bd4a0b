// The standard library's text, parsed and checked: once, for all programs that see it, and only what they name.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/program/scope.h"
#include "lang/text/diagnostic.h"

#include <memory>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace haptel::lang {

// Never changed: any number of compilations read it at once.
struct CheckedLibrary {
    std::shared_ptr<const SourceSet> sources; // with indices from SourceSet::library_files on
    CheckedProgram program;
    Declarations declarations; // of all its files
    Diagnostics diagnostics;   // what there is to say about it; told with every program
    bool is_whole = false;     // everything that the texts declare is here
};

using Names = std::unordered_set<std::string_view>;

// Of these texts, with all that they declare under these names and all that this calls, or with everything; null if
// there are no texts. The texts that were asked for last are kept with what has been asked for of them so far.
std::shared_ptr<const CheckedLibrary> checked_library(const std::vector<SourceFile>& texts, const Names& names);
std::shared_ptr<const CheckedLibrary> whole_library(const std::vector<SourceFile>& texts);

} // namespace haptel::lang
