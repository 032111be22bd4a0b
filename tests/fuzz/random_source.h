// Random programs as source text: functions that call and differentiate each other, loops, branches, arrays, matrices,
// structs, integers, outputs: what the grammar has but images, imports and doc comments, and of an odd seed lines that
// begin with
// '#'. Values are mostly of moderate size, so that rounding can be told from a mistake.
#pragma once

#include <cstdint>
#include <string>

namespace haptel::fuzz {

// One texture "t" with its functions; it compiles without an error. The same for the same seed.
std::string random_source(uint64_t seed);

// The same, but the heads of its loops and the places it reads hold whatever is in scope, the loop's own counter
// among it: it may be refused, for a reason that is told.
std::string odd_source(uint64_t seed);

} // namespace haptel::fuzz
