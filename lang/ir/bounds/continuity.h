// How smooth one operation is over the intervals that its operands lie in.
#pragma once

#include "lang/ir/bounds/variation.h"

#include <span>

namespace haptel::ir {

// `active`: a bit per operand that depends on the point. A kink or jump that the intervals exclude does not count, nor
// does one that only operands can reach which do not depend on the point.
Continuity continuity_of(Op op, std::span<const Interval> operands, uint32_t active, const Interval& result,
                         const Partials& partials);

} // namespace haptel::ir
