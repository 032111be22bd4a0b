// How many operations of a processor one operation of the IR stands for, in the counts of worst cases.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>

namespace haptel::ir {

// 1 for all that are a few instructions or one call of the mathematical library; for Op::spline, the arithmetic that
// spline.h does at worst, and its reads.
uint64_t operations_of(Op op);

} // namespace haptel::ir
