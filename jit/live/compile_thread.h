// The one thread that compiles for live textures: waits for files to change and tells its clients.
#pragma once

#include "jit/live/file_watch.h"

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <sys/eventfd.h>
#include <thread>
#include <vector>

namespace haptel::jit {

class CompileThread {
public:
    using Clock = std::chrono::steady_clock;

    struct Round {
        bool of_files = true;      // some may have changed; else values alone have come
        bool is_writing = false;   // somebody is at a file, which is looked at when that is over
        bool may_take_long = true; // one update a round: a value waits for no more
    };
    struct Place {
        std::mutex at_work; // held during an update
        // Looks at what may have changed, and acts; what takes long and nobody waits for, it does only if it may, and
        // then says that no other may. Throws nothing. Null: no more.
        std::function<void(Round&)> update;
        std::set<std::string> watched;        // files, as of the last update
        std::optional<Clock::time_point> due; // of the next update, at the latest
    };

    // The one of this process; it ends with its last owner.
    static std::shared_ptr<CompileThread> shared();

    CompileThread();
    ~CompileThread();

    // Any thread, from within an update too. It keeps the place for as long as somebody else does.
    void add(const std::shared_ptr<Place>& place);
    // Update soon, without a change of a file.
    void wake();

private:
    void run(const std::stop_token& stop);
    bool wait(Clock::time_point until);
    void update_clients(Round round);

    FileWatch watch;
    Clock::time_point clients_due = Clock::time_point::max(); // of the next of their updates, at the latest
    const int wake_event = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    std::mutex places_mutex; // never held while a client is at work: it may add others
    std::vector<std::shared_ptr<Place>> places;
    std::jthread thread;
};

} // namespace haptel::jit
