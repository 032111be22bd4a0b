// What each line of a texture costs at worst, for `haptel check --cost`.
#pragma once

#include "tools/check/check_report.h"

namespace haptel::tools {

// Lines in order, dearest callers included: [{file, line, operations}]. The sum is operations_max.
Json cost_json(const CheckedTexture& checked);
// The same with shares and source lines, dearest first.
std::string cost_text(const CheckedTexture& checked);

} // namespace haptel::tools
