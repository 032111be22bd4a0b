// From trees to meaning: names, scopes, types, overloads, loop bounds, and what every mistake is and how to mend it.
//
// The checker writes its findings into the tree (resolution.h) and owns what they point to. It needs no memory of
// order: functions may be used before they are declared. What passes is ready for lowering; what does not is in the
// diagnostics, and then lowering must not be tried.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/program/scope.h"
#include "lang/text/diagnostic.h"

#include <memory>
#include <vector>

namespace haptel::lang {

// `made_library`, where this is the library itself: gets what its files declare, and they see each other.
CheckedProgram check(const SourceSet& sources, std::vector<CheckFile> files,
                     std::shared_ptr<const CheckedLibrary> library, Diagnostics& diagnostics,
                     Declarations* made_library = nullptr);

} // namespace haptel::lang
