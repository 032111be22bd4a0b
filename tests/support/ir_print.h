// Text form of the IR, for tests: equal text means an equal module.
#pragma once

#include "lang/ir/ir.h"

#include <string>
#include <string_view>

namespace haptel::ir {

std::string_view to_string(Input input); // "p_x"
std::string print(const Module& module);
std::string print(const Module& module, const Function& function);

} // namespace haptel::ir
