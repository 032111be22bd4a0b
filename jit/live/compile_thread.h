// The one thread that compiles for live textures: waits for files to change and tells its clients.
#pragma once

#include "jit/live/file_watch.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace haptel::jit {

class CompileThread {
public:
    class Client {
    public:
        virtual ~Client() = default;
        // Looks whether its file has changed, and acts. On the compile thread.
        virtual void update() = 0;
        // update() threw: said so, in words. The client stays and is asked again like the others.
        virtual void failed(std::string_view why) = 0;
        // Files to watch for it, as of its last update.
        virtual std::set<std::string> files() const = 0;
    };

    // The one of this process; it ends with its last owner.
    static std::shared_ptr<CompileThread> shared();

    CompileThread();
    ~CompileThread();
    CompileThread(const CompileThread&) = delete;
    CompileThread& operator=(const CompileThread&) = delete;

    // Any thread, from within an update of another client too.
    void add(Client* client);
    void remove(Client* client); // waits while it is being updated
    void wake();                 // update soon, without a change of a file

private:
    using Clock = std::chrono::steady_clock;

    void run();
    void update_clients();
    bool begin_update(Client* client); // false: it is gone
    void end_update();
    static void update(Client& client);
    bool wait(Clock::time_point until); // true: woken by wake()

    FileWatch watch;
    int wake_event;
    std::atomic<bool> stopping{false};
    std::mutex clients_mutex; // never held while a client is at work: it may add and remove others
    std::vector<Client*> clients;
    Client* in_update = nullptr;
    std::condition_variable update_ended;
    std::thread thread;
};

} // namespace haptel::jit
