// The elementary functions, compiled: for the interpreter, constant folding and bounds. elementary_number.h tells how
// they are made.
//
// They are total: at infinities, zeros and NaN what C99 says, but for atan2, which is 0 at the origin. How exact they
// are is Traits::ulp; tests/lang/math/elementary_test.cpp holds them to it.
#pragma once

#include "lang/ir/op_info.h"

namespace haptel::ir {

// Of is_elementary(op); b where it takes two.
double elementary_f64(Op op, double a, double b = 0);

} // namespace haptel::ir
