// Who calls whom. Functions that call themselves, even round corners, would not end; chains of calls are kept short
// enough for every later stage to walk them by recursion, and derivatives of derivatives few enough to be written out.
#pragma once

#include "lang/check.h"

namespace haptel::lang {

// Reports recursion with its cycle and chains that are too long. Otherwise completes FunctionInfo::reads: what is read
// by the functions that a function mentions is read by it.
void check_call_graph(CheckedProgram& program, Diagnostics& diagnostics);

} // namespace haptel::lang
