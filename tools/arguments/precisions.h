// The precisions of machine code by the names that a command line gives them.
#pragma once

#include "jit/codegen/precision.h"

#include <string_view>

namespace haptel::tools {

struct NamedPrecision {
    const char* name;
    jit::Precision precision;
};

// From the closest to the fastest.
inline constexpr NamedPrecision precisions[] = {
    {"f64", jit::Precision::f64}, {"mixed", jit::Precision::mixed}, {"f32", jit::Precision::f32}};

// `name` is one of them.
inline jit::Precision precision_of(std::string_view name)
{
    for (const NamedPrecision& known : precisions)
        if (name == known.name) return known.precision;
    return jit::Precision::f64;
}

} // namespace haptel::tools
