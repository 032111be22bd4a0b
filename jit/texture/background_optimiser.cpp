#include "jit/texture/background_optimiser.h"

#include <chrono>
#include <functional>
#include <sys/resource.h>
#include <unistd.h>

namespace haptel::jit {

namespace {

using namespace std::chrono_literals;

constexpr auto rest = 200ms; // without a new program: whoever edits has paused
constexpr int niceness = 10;

} // namespace

std::shared_ptr<BackgroundOptimiser> BackgroundOptimiser::shared()
{
    static std::mutex mutex;
    static std::weak_ptr<BackgroundOptimiser> current;
    const std::lock_guard lock(mutex);
    std::shared_ptr<BackgroundOptimiser> optimiser = current.lock();
    if (!optimiser) current = optimiser = std::make_shared<BackgroundOptimiser>();
    return optimiser;
}

BackgroundOptimiser::BackgroundOptimiser() : thread([this](const std::stop_token& stop) { run(stop); }) {}

void BackgroundOptimiser::add(const std::shared_ptr<const CompiledProgram>& program)
{
    const std::lock_guard lock(mutex);
    std::erase_if(taken, [](const auto& gone) { return gone.expired(); });
    for (const Programs& known : {std::cref(waiting), std::cref(taken)})
        for (const auto& one : known)
            if (one.lock() == program) return;
    waiting.push_back(program);
    changed.notify_all();
}

void BackgroundOptimiser::run(const std::stop_token& stop)
{
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
    std::unique_lock lock(mutex);
    while (changed.wait(lock, stop, [&] { return !waiting.empty(); }) && !stop.stop_requested()) {
        const size_t before = waiting.size();
        if (changed.wait_for(lock, stop, rest, [&] { return waiting.size() != before; })) continue;
        if (stop.stop_requested()) return;
        const std::weak_ptr<const CompiledProgram> next = waiting.back(); // the newest is the likeliest to be felt
        waiting.pop_back();
        taken.push_back(next);
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
