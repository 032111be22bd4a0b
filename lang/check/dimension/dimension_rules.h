// What the built-in functions do with dimensions: the rules of builtins.def, applied.
#pragma once

#include "lang/check/dimension/dimension.h"
#include "lang/program/builtins.h"

#include <span>
#include <vector>

namespace haptel::lang {

struct DimensionResult {
    Dimension result = Dimension::any();
    // The first argument that does not fit, and what it should be; `fits` if all do.
    bool fits = true;
    size_t argument = 0;
    Dimension expected = Dimension::any();
    bool by_letter = false; // because an argument further left is so
};

// The rule of that function, applied to its arguments.
DimensionResult apply_rule(BuiltinId id, std::span<const Dimension> arguments);

} // namespace haptel::lang
