// What the making of an integer says of its size: enough to prove table indices and trip counts without looking at data
// flow. Builder and verifier use the same rules, each on its own walk.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <span>

namespace haptel::ir {

IntRange full_range(Type type); // of reals: meaningless, [0, 0]
IntRange join(IntRange a, IntRange b);
IntRange constant_range(Type type, uint32_t bits);
IntRange range_of_cells(const Table& table); // looks at each; of reals: as full_range

// Range of the result of `op`, whose type is `type`, from those of its operands.
IntRange range_of(Op op, Type type, std::span<const IntRange> operands);

} // namespace haptel::ir
