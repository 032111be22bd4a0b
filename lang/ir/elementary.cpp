#include "lang/ir/elementary.h"

#include "lang/ir/elementary_functions.h"

namespace haptel::ir {

double elementary_f64(Op op, double a, double b)
{
    return elementary::apply(op, elementary::Number<double>(a), elementary::Number<double>(b)).value;
}

float elementary_f32(Op op, float a, float b)
{
    using R = elementary::Number<float>;
    return elementary::apply(op, R(static_cast<double>(a)), R(static_cast<double>(b))).value;
}

float elementary_f32_of_angle(Op op, double a)
{
    return elementary::apply_to_angle(op, elementary::Number<double>(a)).value;
}

} // namespace haptel::ir
