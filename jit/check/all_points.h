// Shares points out among the machine's processors.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace haptel::jit {

// Calls `make_worker()` once on each thread, and what it gives with the number of each point.
template <typename MakeWorker>
void for_all_points(uint32_t count, const MakeWorker& make_worker)
{
    std::atomic<uint32_t> next{0};
    const auto work = [&] {
        auto worker = make_worker();
        for (uint32_t i = next++; i < count; i = next++) worker(i);
    };
    std::vector<std::thread> threads;
    const uint32_t wanted = std::min({std::thread::hardware_concurrency(), 16u, count / 16});
    for (uint32_t i = 1; i < wanted; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
}

} // namespace haptel::jit
