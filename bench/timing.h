// Times of something done again and again.
#pragma once

#include <functional>
#include <vector>

namespace haptel::bench {

struct Times {
    double median_ms = 0, p99_ms = 0; // p99: the nearest rank, which is the slowest of fewer than 100
};

double milliseconds(const std::function<void()>& work);
Times summary(std::vector<double> times_ms);

} // namespace haptel::bench
