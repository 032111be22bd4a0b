// From trees to meaning: names, scopes, types, overloads, loop bounds, and what every mistake is and how to mend it.
//
// The checker writes its findings into the tree (resolution.h) and owns what they point to. It needs no memory of
// order: functions may be used before they are declared. What passes is ready for lowering; what does not is in the
// diagnostics, and then lowering must not be tried.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

#include <memory>
#include <vector>

namespace haptel::lang {

CheckedProgram check(const SourceSet& sources, std::vector<CheckFile> files,
                     std::shared_ptr<const CheckedLibrary> library, Diagnostics& diagnostics);

// The same of the files of a library, which see each other; makes `checked` but for its sources.
void check(const SourceSet& sources, std::vector<CheckFile> files, CheckedLibrary& checked);

} // namespace haptel::lang
