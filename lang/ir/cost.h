// How much code there is, how many operations it takes at worst, and where they are spent.
//
// The dearer arm of an `if` counts, and loops as often as they may run; what is a few instructions of a processor or
// one call of the mathematical library is one operation. Counts saturate.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <vector>

namespace haptel::ir {

// Instructions of `function` and of all that it calls, each function counted once.
size_t instructions_reached(const Module& module, uint32_t function);

// One call of each of these functions, callees included, by index. `wanted`: with what they call; of others, 0.
std::vector<uint64_t> operations_max(const Module& module, const std::vector<bool>& wanted);
uint64_t operations_max(const Module& module, uint32_t function);

struct SpanCost {
    Span span; // innermost user code: what the library does counts for the call
    uint64_t operations;
};

// What one call of `function` takes, by place in the source, in order of places. The sum is operations_max().
std::vector<SpanCost> cost_by_span(const Module& module, uint32_t function);

} // namespace haptel::ir
