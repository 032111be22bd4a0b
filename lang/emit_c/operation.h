// One operation of the IR as an expression of C99.
#pragma once

#include "lang/ir/ir.h"

#include <span>
#include <string>

namespace haptel::emit_c {

// Operands are names or literals: reals of type double or, where `is_single`, float; integers of type uint32_t, in
// two's complement; truths of type int, 0 or 1; images of type const haptel_image*. What C has no operator for is a
// call of a function of lang/emit_c/helpers.h, or of <math.h> where that is exact or correctly rounded.
std::string expression(ir::Op op, std::span<const std::string> operands, bool is_single);

} // namespace haptel::emit_c
