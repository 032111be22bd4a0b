// The elementary functions by their operation, over any number: Number or a code generator's.
#pragma once

#include "lang/ir/ir.h"
#include "lang/math/elementary_arc.h"
#include "lang/math/elementary_circular.h"
#include "lang/math/elementary_hyperbolic.h"
#include "lang/math/elementary_power.h"

namespace haptel::ir::elementary {

// In f32, of an angle in f64: for takes_angle(op).
template <typename R>
auto apply_to_angle(Op op, R a)
{
    switch (op) {
#define ANGULAR(name, ...)                                                                                             \
    case Op::name: return name(single_circle_of(a), narrow(a));
#define OP(name, ...)                                                                                                  \
    case Op::name: break;
#include "lang/ir/ops.def"
    }
    return narrow(a);
}

// For is_elementary(op). b counts where it takes two.
template <typename R>
R apply(Op op, R a, R b)
{
    switch (op) {
#define ANGULAR(name, ...)                                                                                             \
    case Op::name: return name(circle_of(a), a);
#define ELEMENTARY(name, ...)                                                                                          \
    case Op::name: return name(a);
#define ELEMENTARY2(name, ...)                                                                                         \
    case Op::name: return name(a, b);
#define OP(name, ...)                                                                                                  \
    case Op::name: break;
#include "lang/ir/ops.def"
    }
    return a;
}

} // namespace haptel::ir::elementary
