// Small independent check of final IR: what a servo may rely on, whoever made the program.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <string>

namespace haptel::ir {

constexpr uint64_t operations_limit = 10'000'000; // worst case of one call of an entry
constexpr uint32_t nesting_max = 512;             // blocks and calls inside each other: bounds every recursion

// Empty if all is well, else the first thing that is not: types, arity, dominance, calls that go forward (recursion),
// table indices neither constant nor clamped, trip counts that may exceed trip_max, input reads outside entries,
// worst-case cost.
std::string verify(const Module& module);

} // namespace haptel::ir
