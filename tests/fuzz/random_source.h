// Random valid programs as source text: functions that call and differentiate each other, loops, branches, arrays,
// matrices, integers. Values are mostly of moderate size, so that rounding can be told from a mistake.
#pragma once

#include <cstdint>
#include <string>

namespace haptel::fuzz {

// One texture "t" with its functions; it compiles without an error. The same for the same seed.
std::string random_source(uint64_t seed);

} // namespace haptel::fuzz
