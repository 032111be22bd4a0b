// Where the operations of a worst case are spent.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <vector>

namespace haptel::ir {

struct SpanCost {
    Span span; // innermost user code: what the library does counts for the call
    uint64_t operations;
};

// One call of `function`, callees included, by place in the source, in order of places. The sum is operations_max()
// (verify.h), which counts the dearer arm of an `if`, and loops as often as they may run.
std::vector<SpanCost> cost_by_span(const Module& module, uint32_t function);

} // namespace haptel::ir
