// The elementary functions, compiled: for the interpreter, constant folding and bounds. elementary_number.h tells how
// they are made.
//
// They are total: at infinities, zeros and NaN what C99 says, but for atan2, which is 0 at the origin. How exact they
// are is elementary_error(); tests/lang/math/elementary_test.cpp holds them to it.
#pragma once

#include "lang/ir/ir.h"

namespace haptel::ir {

bool is_elementary(Op op); // sin ... pow, all but the turn forms
bool takes_angle(Op op);   // sin, cos, tan: those that in f32 may be of an f64

// b: for pow and atan2.
double elementary_f64(Op op, double a, double b = 0);
float elementary_f32(Op op, float a, float b = 0);
float elementary_f32_of_angle(Op op, double a);

// The largest error over the whole range, in units in the last place of the exact result in either format.
double elementary_error(Op op);

} // namespace haptel::ir
