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

// For the calling thread: it wakes when it asked to, not up to 50 us later, as ordinary threads do by default.
void use_exact_timers() noexcept;

// For the calling thread: SCHED_FIFO and memory locked and touched; where that is refused, at least
// exact timers.
RealTime ask_for_real_time();

// The calling thread on that processor alone, counted from 0, so that its caches stay warm and nothing moves it. Why
// not, in words, or nothing.
std::string bind_to_core(unsigned core);

// Nanoseconds that the calling thread has spent on a processor.
int64_t processor_ns() noexcept;

// Until `deadline_ns`: sleeps, and spins over the last `spin_ns` of it. Returns the time when it came back.
int64_t wait_until(int64_t deadline_ns, int64_t spin_ns) noexcept;

} // namespace haptel::runtime
