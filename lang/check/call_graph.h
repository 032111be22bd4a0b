// Who calls whom, and how deep.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

namespace haptel::lang {

// Functions that call themselves, even round corners, would not end; chains of calls are kept short enough for every
// later stage to walk them by recursion, and derivatives of derivatives few enough to be written out. What is reported
// of neither gets its FunctionInfo::call_depth and derivative_order, and adds what is read by functions that it
// mentions to what it reads.
void check_call_graph(CheckedProgram& program, Diagnostics& diagnostics);

} // namespace haptel::lang
