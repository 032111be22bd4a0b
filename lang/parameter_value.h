// A texture parameter's value as scenes, sliders and command lines write it: "60um", "-5", "true", and the names of
// choices. Bare numbers are SI.
#pragma once

#include "lang/ir/ir.h"

#include <string>
#include <string_view>

namespace haptel::lang {

struct ParameterValue {
    double value = 0;         // SI; integers exactly, booleans 0 or 1
    std::string error = {};   // what was expected and what was found; empty: nothing is wrong
    std::string hint = {};    // for the error
    std::string warning = {}; // of a real number outside of its range
};

// `text` is any bytes; blanks around it do not count. A real number may lie outside its range, which is for sliders; a
// whole number may not, because loops and tables rely on it.
ParameterValue parse_value(std::string_view text, const ir::Parameter& parameter);

} // namespace haptel::lang
