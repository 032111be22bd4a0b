#include "jit/texture/background_optimiser.h"

#include <chrono>
#include <cstdlib>
#include <sys/resource.h>
#include <unistd.h>

namespace haptel::jit {

using namespace std::chrono_literals;

namespace {

constexpr auto rest = 200ms; // without a new program: whoever edits has paused
constexpr int niceness = 10;

} // namespace

BackgroundOptimiser& BackgroundOptimiser::shared()
{
    // Not destroyed, because other threads may add to the last; but stopped before LLVM's own objects go.
    static auto& optimiser = *new BackgroundOptimiser;
    return optimiser;
}

BackgroundOptimiser::BackgroundOptimiser() : thread([this] { run(); })
{
    std::atexit([] { shared().stop(); });
}

void BackgroundOptimiser::stop()
{
    {
        const std::lock_guard lock(mutex);
        is_stopping = true;
    }
    changed.notify_all();
    thread.join();
}

void BackgroundOptimiser::add(const std::shared_ptr<const CompiledProgram>& program)
{
    if (!program || program->is_optimised()) return;
    {
        const std::lock_guard lock(mutex);
        waiting.push_back(program);
    }
    changed.notify_all();
}

void BackgroundOptimiser::run()
{
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
    std::unique_lock lock(mutex);
    while (!is_stopping) {
        if (waiting.empty()) {
            changed.wait(lock);
            continue;
        }
        if (const size_t before = waiting.size();
            changed.wait_for(lock, rest, [&] { return is_stopping || waiting.size() != before; }))
            continue;
        const std::weak_ptr<const CompiledProgram> next = waiting.back(); // the newest is the likeliest to be felt
        waiting.pop_back();
        lock.unlock();
        try {
            if (const auto program = next.lock()) program->optimise();
        } catch (...) {
            // No memory for faster code: the draft stays.
        }
        lock.lock();
    }
}

} // namespace haptel::jit
