// How many operations of a processor one operation of the IR stands for, in the counts of worst cases.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>

namespace haptel::ir {

// 1 for all that are a few instructions or one call of the mathematical library; for Op::spline, the arithmetic that
// spline.h does at worst, and its reads.
uint64_t operations_of(Op op);

// Of counts, which saturate.
inline uint64_t plus(uint64_t a, uint64_t b)
{
    uint64_t sum = 0;
    return __builtin_add_overflow(a, b, &sum) ? UINT64_MAX : sum;
}
inline uint64_t times(uint64_t a, uint64_t b)
{
    uint64_t product = 0;
    return __builtin_mul_overflow(a, b, &product) ? UINT64_MAX : product;
}

} // namespace haptel::ir
