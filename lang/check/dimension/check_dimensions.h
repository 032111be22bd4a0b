// Physical dimensions of a program that passed check(): adding a length to a number, the sine of a length and the like
// are warnings with the code `dimension`.
//
// Functions are generic: each is looked at anew for the dimensions that it is called with, once per choice of them. A
// finding names the innermost code of the user's own; what goes wrong inside the library is the fault of the call.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

namespace haptel::lang {

void check_dimensions(const SourceSet& sources, const CheckedProgram& program, Diagnostics& diagnostics);

} // namespace haptel::lang
