// Compiled once: it is much code.
#include "lang/ir/elementary_functions.h"
#include "lang/ir/semantics.h"

namespace haptel::ir {

double elementary_f64(Op op, double a, double b)
{
    return elementary::apply(op, elementary::Number<double>(a), elementary::Number<double>(b)).value;
}

} // namespace haptel::ir
