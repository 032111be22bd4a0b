#include "bench/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

namespace haptel::bench {

double milliseconds(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double processor_milliseconds(const std::function<void()>& work)
{
    const auto now = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
    };
    const double start = now();
    work();
    return now() - start;
}

Times summary(std::vector<double> times)
{
    if (times.empty()) return {};
    std::sort(times.begin(), times.end());
    const auto rank = [&](double share) {
        const auto index = static_cast<size_t>(std::ceil(share * static_cast<double>(times.size())));
        return times[std::max<size_t>(index, 1) - 1];
    };
    return {rank(0.5), rank(0.99), rank(0.999)};
}

double clock_reading_ns()
{
    auto least = std::chrono::steady_clock::duration::max();
    for (int i = 0; i < 1000; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        least = std::min(least, std::chrono::steady_clock::now() - begin);
    }
    return std::chrono::duration<double, std::nano>(least).count();
}

} // namespace haptel::bench
