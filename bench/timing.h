// Times of something done again and again.
#pragma once

#include <functional>
#include <vector>

namespace haptel::bench {

// Of times in one unit.
struct Times {
    double median = 0, p99 = 0, p999 = 0; // the nearest rank: p99 is the slowest of fewer than 100
};

double milliseconds(const std::function<void()>& work); // as the clock on the wall runs
// Of this thread on a processor: what others do on the machine meanwhile is not counted, but for what they do to
// caches.
double processor_milliseconds(const std::function<void()>& work);
Times summary(std::vector<double> times);

// What reading the clock once adds at least to a time measured between two readings, now: a machine's speed changes.
double clock_reading_ns();

} // namespace haptel::bench
