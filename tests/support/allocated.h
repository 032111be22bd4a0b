// How much a piece of work allocates: a count that grows with what it makes, and is the same on every machine.
#pragma once

#include <cstdint>

namespace haptel::test {

// Bytes that this thread has asked operator new for since it started.
uint64_t allocated_bytes() noexcept;

} // namespace haptel::test
