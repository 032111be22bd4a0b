// Which values of a function differ between the points that one piece of code evaluates at once.
#pragma once

#include "lang/ir/ir.h"

#include <vector>

namespace haptel::jit {

// Inputs of the point vary, what the block holds does not, and of the function's parameters those vary that
// `parameters` says; whatever rests on what varies varies itself. By ir::Value::index. The results of a call vary
// together: all of them if one argument does.
std::vector<bool> varying_values(const ir::Function& function, const std::vector<bool>& parameters);

} // namespace haptel::jit
