#include "jit/live/compile_thread.h"

#include <algorithm>
#include <cstdint>
#include <poll.h>
#include <unistd.h>

namespace haptel::jit {

namespace {

using namespace std::chrono_literals;

// Looks at the files unasked: for what inotify does not tell, and for folders that were not there.
constexpr auto unasked = 1s;

} // namespace

std::shared_ptr<CompileThread> CompileThread::shared()
{
    static std::mutex mutex;
    static std::weak_ptr<CompileThread> current;
    const std::lock_guard lock(mutex);
    std::shared_ptr<CompileThread> thread = current.lock();
    if (!thread) current = thread = std::make_shared<CompileThread>();
    return thread;
}

CompileThread::CompileThread() : thread([this](const std::stop_token& stop) { run(stop); }) {}

CompileThread::~CompileThread()
{
    thread.request_stop();
    wake();
    thread.join();
    close(wake_event);
}

void CompileThread::add(const std::shared_ptr<Place>& place)
{
    {
        const std::lock_guard lock(places_mutex);
        places.push_back(place);
    }
    wake();
}

void CompileThread::wake()
{
    const uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(wake_event, &one, sizeof one);
}

void CompileThread::run(const std::stop_token& stop)
{
    Settling settling;
    Clock::time_point files_due = Clock::now();
    while (!stop.stop_requested()) {
        const bool is_woken = wait(std::min(files_due, clients_due));
        const FileWatch::Change change = watch.take();
        const auto now = Clock::now();
        if (change != FileWatch::Change::none) files_due = settling.due_after(change, now);
        const bool of_files = now >= files_due;
        if (!of_files && !is_woken && now < clients_due) continue;
        update_clients({.of_files = of_files, .is_writing = !of_files && settling.is_awaited()});
        if (!of_files) continue;
        settling.read();
        files_due = Clock::now() + unasked;
    }
}

// True: woken by wake().
bool CompileThread::wait(Clock::time_point until)
{
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    pollfd descriptors[] = {{wake_event, POLLIN, 0}, {watch.descriptor(), POLLIN, 0}};
    poll(descriptors, 2, static_cast<int>(std::max<int64_t>(left.count(), 0)));
    uint64_t count = 0;
    return read(wake_event, &count, sizeof count) == sizeof count;
}

// Of those that there are at the start: who is added meanwhile wakes the thread anew.
void CompileThread::update_clients(Round round)
try {
    clients_due = Clock::time_point::max();
    std::unique_lock lock(places_mutex);
    std::erase_if(places, [](const auto& place) { return place.use_count() == 1; });
    const std::vector<std::shared_ptr<Place>> all = places;
    lock.unlock();
    std::set<std::string> files;
    for (const auto& place : all) {
        const std::lock_guard at_work(place->at_work);
        if (!place->update) continue;
        place->update(round);
        files.insert(place->watched.begin(), place->watched.end());
        if (!round.is_writing) clients_due = std::min(clients_due, place->due.value_or(clients_due));
    }
    watch.watch(files);
} catch (...) {
    // No memory for the list of files: the watch is as it was, and this is tried again in a moment.
}

} // namespace haptel::jit
