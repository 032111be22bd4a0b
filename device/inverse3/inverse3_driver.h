// The thread that speaks with the Inverse3 service: finds the device, exchanges the newest force for the newest place,
// and does so again when the service was restarted.
//
// The service answers each message with one state and says nothing unasked, and the device holds the force that it
// heard last, whoever said it. So the first message of a connection says no force, and so does the last; and where a
// connection is lost with a force on it, the next one is made at once, to take it away.
#pragma once

#include "device/inverse3/inverse3_greeting.h"
#include "device/usb/newest.h"

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace haptel::device {

struct Inverse3Times {
    int connect_ms = 1000;    // to connect and to hear the inventory
    int silence_ms = 500;     // a service that owes a state for so long is lost
    int keep_alive_ms = 5;    // without a command the newest is said again after so long, so that places go on
    int watchdog_ms = 3;      // without a command for so long, the force is taken away
    int close_ms = 100;       // to say goodbye
    int rescue_ms = 200;      // to connect once more at the end, where a force is left
    int pose_age_max_ms = 10; // an older state is no pose
    int again_ms = 500;       // between two tries
    int tries = 10;           // with a service that talks nonsense, before that is a fault
    double patience_s = 60;   // absent for so long, it is disconnected for good
    bool real_time = true;    // asks the system not to be late
    bool guarded = true;      // by a process beside this one (force_guard.h)
};

enum class Inverse3Phase : uint8_t { connecting, streaming, disconnected, failed };

struct Inverse3Reading {
    Inverse3State state;
    bool is_centred = false;
    int64_t time_ns = 0;
    uint32_t session = 0; // counts from 1 on: another one after each connection
    int64_t link_ns = 0;  // since the message that it answers was sent; 0: not known
};

struct Inverse3Counters {
    uint64_t sent = 0, states = 0;
    uint64_t dropped = 0; // forces taken away because the servo was silent
};

class Inverse3Driver {
public:
    Inverse3Driver(ServiceAddress address, std::string id, const Inverse3Times& times);
    ~Inverse3Driver(); // zero force; comes back within a second
    Inverse3Driver(const Inverse3Driver&) = delete;
    Inverse3Driver& operator=(const Inverse3Driver&) = delete;

    // The servo's thread: nothing of this allocates, locks or waits.
    bool newest(Inverse3Reading& reading) noexcept { return readings_.take(reading); }
    // Of a place of that session; where it is over, so is the force.
    void command(const glm::dvec3& force_n, uint32_t session) noexcept;
    uint32_t session() const noexcept { return session_.load(std::memory_order_acquire); } // 0: none
    Inverse3Phase phase() const noexcept { return phase_.load(std::memory_order_acquire); }
    bool force_was_dropped() noexcept { return dropped_.exchange(false, std::memory_order_acq_rel); }
    void halt() noexcept; // zero force for good

    const Inverse3Times& times() const noexcept { return times_; }
    std::string state() const;                  // in words. Any thread but the servo's
    Inverse3Counters counters() const noexcept; // any thread

private:
    struct Command {
        glm::dvec3 force_n{0};
        int64_t time_ns = 0;
        uint32_t session = 0;
    };
    struct Ending {
        std::string reason; // in words; empty: the driver quits
        bool is_absent = false;
    };

    void run();
    bool connect_and_exchange(int& failures); // false: there is no use in going on
    Ending converse(ServiceSocket& socket, const Inverse3Listed& device);
    Ending exchange(ServiceSocket& socket, const Inverse3Listed& device);
    Ending hear(const ServiceSocket& socket, const Inverse3Listed& device);
    Inverse3Choice choose(const Inverse3Inventory& inventory);
    glm::dvec3 wanted_n(int64_t now_ns) const noexcept;
    bool is_due(const glm::dvec3& force_n, int64_t now_ns) const noexcept;
    int64_t next_deadline_ns() const noexcept;
    void note_what_is_dropped(const glm::dvec3& force_n) noexcept;
    void was_silenced() noexcept;
    void count_dropped() noexcept;
    void say(ServiceSocket& socket, std::string_view message, const std::string& id, const glm::dvec3& force_n);
    void say_last(ServiceSocket& socket, const std::string& id);
    void take_force_away_at_the_end();
    void enter(Inverse3Phase phase, std::string state);
    void pause() const;
    bool quitting() const noexcept { return quit_.load(std::memory_order_acquire); }

    const ServiceAddress address_;
    const std::string id_; // empty: any
    const Inverse3Times times_;
    WakeEvent wake_;
    Newest<Command> commands_;
    Newest<Inverse3Reading> readings_;
    std::atomic<uint32_t> session_{0};
    std::atomic<Inverse3Phase> phase_{Inverse3Phase::connecting};
    std::atomic<bool> quit_{false}, halted_{false}, dropped_{false};
    std::atomic<uint64_t> sent_count_{0}, states_count_{0}, dropped_count_{0};
    mutable std::mutex state_mutex_;
    std::string state_ = "connecting";

    // The driver's thread alone.
    Command command_;
    bool is_fresh_ = false; // the command was not said yet
    glm::dvec3 said_n_{0};  // by the newest message
    int64_t said_ns_ = 0;
    int64_t owed_since_ns_ = 0;   // since when a state is awaited
    int64_t unsure_until_ns_ = 0; // the guard may have spoken, and an answer be to that
    int64_t asked_ns_ = 0;        // when the one message was sent that a state is owed for; 0: none, or several
    int owed_ = 0;                // states
    std::string held_by_;         // the device that may still hold a force of ours; empty: none does
    uint32_t sessions_ = 0;
    uint64_t session_states_ = 0;
    int64_t absent_since_ns_ = 0; // 0: it is there
    std::thread thread_;          // last: starts when all else is there
};

} // namespace haptel::device
