// Who calls whom. Functions that call themselves, even round corners, would not end; chains of calls are kept short
// enough for every later stage to walk them by recursion, and derivatives of derivatives few enough to be written out.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

#include <unordered_map>

namespace haptel::lang {

// How deep the calls of a function go.
struct CallDepth {
    uint32_t length = 1; // of the longest chain of calls that starts here
    uint32_t order = 0;  // derivatives of derivatives that it takes, at most
};
using CallDepths = std::unordered_map<const FunctionInfo*, CallDepth>;

// Reports recursion with its cycle and chains that are too long. Otherwise completes FunctionInfo::reads: what is read
// by the functions that a function mentions is read by it. Functions that are not the program's own are in `known`.
// Returns the program's own, but for those of cycles.
CallDepths check_call_graph(CheckedProgram& program, const CallDepths& known, Diagnostics& diagnostics);

} // namespace haptel::lang
