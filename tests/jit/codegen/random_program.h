// Random valid IR: typed operations over what is in scope, nested branches and loops, calls, table reads.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>

namespace haptel::test {

// One texture with a height entry that reads p_x, p_y, p_z and n_x; the same for the same seed.
ir::Module random_program(uint64_t seed);

} // namespace haptel::test
