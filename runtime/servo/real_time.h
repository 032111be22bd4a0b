// What the operating system can do for a thread that must not be late, asked for politely.
#pragma once

#include <cstdint>
#include <string>

namespace haptel::runtime {

// Nanoseconds of CLOCK_MONOTONIC.
int64_t monotonic_ns() noexcept;

// Default floating point environment for the calling thread: round to nearest, no traps, subnormals neither flushed nor
// taken as zero. Threads inherit these from whoever starts them, hence the need.
void set_exact_floating_point() noexcept;

struct RealTime {
    bool granted = false;
    std::string note; // what was refused and how to get it; empty when granted
};

// For the calling thread: SCHED_FIFO and memory locked and touched; where that is refused, at least a timer that is not
// delayed by the default slack of 50 us.
RealTime ask_for_real_time();

// Until `deadline_ns`: sleeps, and spins over the last `spin_ns` of it. Returns the time when it came back.
int64_t wait_until(int64_t deadline_ns, int64_t spin_ns) noexcept;

} // namespace haptel::runtime
