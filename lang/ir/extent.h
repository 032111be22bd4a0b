// How much code there is, not how often it runs (cost.h).
#pragma once

#include "lang/ir/ir.h"

namespace haptel::ir {

// Whether `function`, or what it calls, holds each function of the module up to it: itself included.
std::vector<bool> reached_from(const Module& module, uint32_t function);

// Instructions of these functions together, each counted once.
size_t instructions_reached(const Module& module, uint32_t function);

} // namespace haptel::ir
