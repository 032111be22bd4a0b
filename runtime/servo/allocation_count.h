// Counts heap allocations per thread, to prove that a servo tick makes none, and that a compiler's work is linear.
//
// The counter replaces malloc and its family (operator new ends there), so it is an object library of its own that
// only programs which want the figure link: haptel_allocation_count. Under a sanitizer, whose allocator must stay, it
// listens through the sanitizer's own hooks.
#pragma once

#include <cstdint>

namespace haptel::runtime {

// Allocations of the calling thread since it started. Fits ServoOptions::allocation_count.
uint64_t allocations_of_this_thread() noexcept;

// What they asked for, in bytes: a measure of work that is the same on every machine.
uint64_t allocated_bytes_of_this_thread() noexcept;

} // namespace haptel::runtime
