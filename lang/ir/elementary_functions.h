// The elementary functions by their operation, over any number: Number or a code generator's.
#pragma once

#include "lang/ir/ir.h"
#include "lang/math/elementary_arc.h"
#include "lang/math/elementary_circular.h"
#include "lang/math/elementary_hyperbolic.h"
#include "lang/math/elementary_power.h"

namespace haptel::ir::elementary {

// In f32, of an angle in f64: for sin, cos and tan.
template <typename R>
auto apply_to_angle(Op op, R a)
{
    return op == Op::sin ? single_sin(a) : op == Op::cos ? single_cos(a) : single_tan(a);
}

// For is_elementary(op). b counts for pow and atan2 alone.
template <typename R>
R apply(Op op, R a, R b)
{
    switch (op) {
    case Op::sin:
    case Op::cos:
    case Op::tan:
        if constexpr (R::is_single)
            return apply_to_angle(op, widen(a));
        else
            return op == Op::sin ? sin(a) : op == Op::cos ? cos(a) : tan(a);
    case Op::asin: return asin(a);
    case Op::acos: return acos(a);
    case Op::atan: return atan(a);
    case Op::atan2: return atan2(a, b);
    case Op::sinh: return sinh(a);
    case Op::cosh: return cosh(a);
    case Op::tanh: return tanh(a);
    case Op::asinh: return asinh(a);
    case Op::acosh: return acosh(a);
    case Op::atanh: return atanh(a);
    case Op::exp: return exp(a);
    case Op::exp2: return exp2(a);
    case Op::log: return log(a);
    case Op::log2: return log2(a);
    case Op::pow: return pow(a, b);
    default: return a;
    }
}

} // namespace haptel::ir::elementary
