#include "runtime/surface/in_parallel.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace haptel::runtime {

void in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& part)
{
    if (threads == 0) threads = std::thread::hardware_concurrency(); // of those that this process may use
    std::atomic<std::size_t> next{0};
    std::mutex failing;
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            for (std::size_t i; (i = next.fetch_add(1)) < count;) part(i);
        } catch (...) {
            const std::lock_guard lock(failing);
            failure = std::current_exception();
            next = count;
        }
    };
    std::vector<std::jthread> others;
    try {
        others.reserve(threads);
        while (others.size() + 1 < std::min<std::size_t>(threads, count)) others.emplace_back(work);
    } catch (const std::system_error&) { // no more threads to be had: those that are do it all
    }
    work();
    others.clear();
    if (failure) std::rethrow_exception(failure);
}

} // namespace haptel::runtime
