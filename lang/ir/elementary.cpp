#include "lang/ir/elementary.h"

#include "lang/ir/elementary_functions.h"

namespace haptel::ir {

bool is_elementary(Op op)
{
    return op >= Op::sin && op <= Op::pow && op != Op::sinturn && op != Op::costurn;
}

bool takes_angle(Op op)
{
    return op == Op::sin || op == Op::cos || op == Op::tan;
}

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

double elementary_error(Op op)
{
    const bool has_quotient = op == Op::tan || op == Op::atan || op == Op::atan2 || op == Op::tanh || op == Op::asinh ||
                              op == Op::acosh || op == Op::atanh; // whose rounding adds to that of the sum
    return has_quotient ? 2 : 1;
}

} // namespace haptel::ir
