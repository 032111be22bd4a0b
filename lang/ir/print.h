// The IR as text: equal texts, equal modules. `haptel build --emit ir` shows it to people, and tests read it back.
#pragma once

#include "lang/ir/ir.h"

#include <string>
#include <string_view>

namespace haptel::ir {

std::string_view to_string(Input input); // "p_x"
std::string print(const Module& module);
std::string print(const Module& module, const Function& function);

} // namespace haptel::ir
