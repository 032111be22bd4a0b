// Random valid programs, written as raw instructions: nothing of the builder is trusted.
#pragma once

#include "lang/ir/semantics.h"

#include <cstdint>
#include <vector>

namespace ir_test {

using namespace haptel::ir;

enum class Flavour {
    tame, // values of moderate size, smooth pieces: derivatives can be compared with differences
    wild  // every operation, constants that are NaN, infinite, -0, subnormal
};

// Functions that call each other; the last is the one to run. Arguments: three reals, i32, u32, bool; results: two
// reals and, if wild, an i32.
Module random_module(uint32_t seed, Flavour flavour);

std::vector<Slot<double>> random_arguments(const Function& function, uint32_t seed, Flavour flavour = Flavour::tame);

} // namespace ir_test
