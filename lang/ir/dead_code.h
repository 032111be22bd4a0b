// What results depend on: instructions, results of `if`, carried values of loops.
#pragma once

#include "lang/ir/ir.h"

#include <functional>

namespace haptel::ir {

// Of a function that is called, which parameters those of its results are made from.
using ParametersNeeded = std::function<std::vector<bool>(uint32_t function, const std::vector<bool>& results)>;

// By Value::index: whether one of those results of the function is made from it.
std::vector<bool> needed_values(const Function& function, const std::vector<bool>& results,
                                const ParametersNeeded& parameters);

// Removes what no result depends on. Renumbers values densely, in order of appearance.
void remove_dead_code(Function& function);

} // namespace haptel::ir
