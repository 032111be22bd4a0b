// Which values of a function differ between the points that one piece of code evaluates at once.
#pragma once

#include "jit/codegen/iteration_lanes.h"

#include <vector>

namespace haptel::jit {

// Inputs of the point vary, what the block holds does not, and of the function's parameters those vary that
// `parameters` says; whatever rests on what varies varies itself. By ir::Value::index. The results of a call vary
// together: all of them if one argument does.
std::vector<bool> varying_values(const ir::Function& function, const std::vector<bool>& parameters);

// The same between the iterations of one loop, for one point: of the body of each of `loops`, of the ordered ones or of
// the others, or of everything where those of the function's parameters vary.
std::vector<bool> varying_iterations(const ir::Function& function, const std::vector<bool>& parameters,
                                     const LaneLoops& loops, bool ordered);

} // namespace haptel::jit
