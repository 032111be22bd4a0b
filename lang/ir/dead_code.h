// Removes what no result depends on: instructions, results of `if`, carried values of loops. Renumbers values densely,
// in order of appearance.
#pragma once

#include "lang/ir/ir.h"

namespace haptel::ir {

void remove_dead_code(Function& function);

} // namespace haptel::ir
