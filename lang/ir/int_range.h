// What the making of an integer says of its size: enough to prove table indices and trip counts without looking at data
// flow. Builder and verifier use the same rules, each on its own walk.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <span>

namespace haptel::ir {

// Inclusive. i32 values as signed, u32 values as unsigned, booleans as 0 and 1.
struct IntRange {
    int64_t minimum, maximum;
    bool is_constant() const { return minimum == maximum; }
    bool within(int64_t low, int64_t high) const { return low <= minimum && maximum <= high; }
    bool operator==(const IntRange&) const = default;
};

IntRange full_range(Type type); // of reals: meaningless, [0, 0]
IntRange join(IntRange a, IntRange b);

// Range of the result of `op`, whose type is `type`, from those of its operands.
IntRange range_of(Op op, Type type, std::span<const IntRange> operands);

} // namespace haptel::ir
