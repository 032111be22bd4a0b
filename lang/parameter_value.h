// A texture parameter's value as scenes, sliders and command lines write it: "60um", "-5", "true", and the names of
// choices. Bare numbers are SI.
#pragma once

#include "lang/ir/ir.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

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

// Of all that a name sets: a parameter, a component "size.x", or as "size" every component, in the text "21cm, 7cm".
struct ParameterValues {
    std::span<const ir::Parameter> parameters; // of the texture, one behind the other; none: nothing has this name
    std::vector<ParameterValue> values = {};   // one for each; after a mistake one alone, which says what is wrong
};
ParameterValues parse_values(std::string_view name, std::string_view text, const ir::Texture& texture);
std::span<const ir::Parameter> parameters_called(std::string_view name, const ir::Texture& texture);

// Every name that sets something, "size" before "size.x".
std::vector<std::string> parameter_names(const ir::Texture& texture);

} // namespace haptel::lang
