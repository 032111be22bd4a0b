// Seconds from one lap to the next.
#pragma once

#include <chrono>
#include <utility>

namespace haptel::jit {

class Stopwatch {
public:
    double lap_s()
    {
        const Clock::time_point now = Clock::now();
        return std::chrono::duration<double>(now - std::exchange(start, now)).count();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start = Clock::now();
};

} // namespace haptel::jit
