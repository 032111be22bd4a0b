// Who calls whom. Functions that call themselves, even round corners, would not end; chains of calls are kept short
// enough for every later stage to walk them by recursion, and derivatives of derivatives few enough to be written out.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

namespace haptel::lang {

// Reports recursion with its cycle and chains that are too long. Otherwise completes what the program's functions know
// of their calls: FunctionInfo::call_depth, derivative_order, and `reads`, by what they mention.
void check_call_graph(CheckedProgram& program, Diagnostics& diagnostics);

} // namespace haptel::lang
