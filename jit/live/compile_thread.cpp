#include "jit/live/compile_thread.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace haptel::jit {

using namespace std::chrono_literals;

namespace {

// After the last sign that a file is complete: an editor's rename and what belongs to it are over by then.
constexpr auto settle_after_written = 10ms;
// After a write without an end: the writer is at work, or keeps the file open.
constexpr auto settle_after_writing = 150ms;
constexpr auto settle_longest = 1s; // since the first sign, however many follow
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

CompileThread::CompileThread() : wake_event(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)), thread([this] { run(); }) {}

CompileThread::~CompileThread()
{
    stopping = true;
    wake();
    thread.join();
    close(wake_event);
}

void CompileThread::add(Client* client)
{
    {
        const std::lock_guard lock(clients_mutex);
        clients.push_back(client);
    }
    wake();
}

void CompileThread::remove(Client* client)
{
    std::unique_lock lock(clients_mutex);
    std::erase(clients, client);
    update_ended.wait(lock, [&] { return in_update != client; });
}

void CompileThread::wake()
{
    const uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(wake_event, &one, sizeof one);
}

bool CompileThread::wait(Clock::time_point until)
{
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    pollfd descriptors[] = {{wake_event, POLLIN, 0}, {watch.descriptor(), POLLIN, 0}};
    poll(descriptors, 2, static_cast<int>(std::max<int64_t>(left.count(), 0)));
    uint64_t count = 0;
    return read(wake_event, &count, sizeof count) == sizeof count;
}

// Nothing that a client does may end the thread, and with it the process and the force in somebody's hand.
void CompileThread::update(Client& client)
try {
    try {
        client.update();
    } catch (const std::exception& problem) {
        client.failed(problem.what());
    } catch (...) {
        client.failed("for a reason that has no words");
    }
} catch (...) {
    // Not even telling went well.
}

bool CompileThread::begin_update(Client* client)
{
    const std::lock_guard lock(clients_mutex);
    if (std::find(clients.begin(), clients.end(), client) == clients.end()) return false;
    in_update = client;
    return true;
}

void CompileThread::end_update()
{
    const std::lock_guard lock(clients_mutex);
    in_update = nullptr;
    update_ended.notify_all();
}

// Of those that there are at the start: who is added meanwhile wakes the thread anew.
void CompileThread::update_clients()
try {
    std::unique_lock lock(clients_mutex);
    const std::vector<Client*> all = clients;
    lock.unlock();
    std::set<std::string> files;
    for (Client* client : all) {
        if (!begin_update(client)) continue;
        update(*client);
        try {
            files.merge(client->files());
        } catch (...) {
            end_update();
            throw;
        }
        end_update();
    }
    watch.watch(files);
} catch (...) {
    // No memory for the list of files: the watch is as it was, and this is tried again in a moment.
}

void CompileThread::run()
{
    std::optional<Clock::time_point> first_change;
    Clock::time_point due = Clock::now();
    while (!stopping) {
        const bool woken = wait(due);
        const FileWatch::Change change = watch.take();
        const auto now = Clock::now();
        if (change != FileWatch::Change::none) {
            if (!first_change) first_change = now;
            const auto settled = change == FileWatch::Change::written ? settle_after_written : settle_after_writing;
            due = std::min(now + settled, *first_change + settle_longest);
        }
        if (now < due && (!woken || first_change)) continue;
        update_clients();
        first_change.reset();
        due = Clock::now() + unasked;
    }
}

} // namespace haptel::jit
