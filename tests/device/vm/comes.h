// Waits for what another thread, another process or the kernel does, at most for a while.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace haptel::device {

inline bool comes(const std::function<bool()>& happens)
{
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!happens() && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return happens();
}

} // namespace haptel::device
