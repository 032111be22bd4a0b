// The thread that serves a wheel or a stick: finds out which way its motors push, hands over its newest place, sends it
// the newest force, and opens it anew when it was unplugged.
//
// Which way a positive level pushes differs between makes, and a wrong sign throws the wheel away from the hand. So
// each axis is nudged before the first force: with more and more of its force, for a moment, until it moves. Each nudge
// begins from rest, for what coasts tells nothing of its motor. One that does not move is held fast or has no motor; it
// has no force until it does.
#pragma once

#include "device/evdev/input_port.h"
#include "device/usb/newest.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace haptel::device {

using OpenInput = std::function<OpenedInput()>;

struct EvdevTimes {
    int update_ms = 2;    // between two forces: as often as drivers in the kernel send them on
    int replay_ms = 1000; // an effect is played again, before the kernel or the device ends it
    int watchdog_ms = 5;  // without a command for so long, the force is taken away
    int nudge_ms = 120;   // each
    int again_ms = 500;   // between two tries to open or to nudge
    double patience_s = 60;
};

enum class EvdevPhase : uint8_t { connecting, nudging, running, disconnected, failed };

// Shares of the way from one end of the axis to the other, 0 in the middle: -0.5 .. 0.5.
struct EvdevReading {
    std::array<double, 2> place{};
    uint32_t session = 0; // counts from 1 on: another one after each opening
};

class EvdevDriver {
public:
    EvdevDriver(OpenInput open, const EvdevTimes& times);
    ~EvdevDriver(); // zero force; comes back within a second
    EvdevDriver(const EvdevDriver&) = delete;
    EvdevDriver& operator=(const EvdevDriver&) = delete;

    // The servo's thread: nothing of this allocates, locks or waits.
    bool newest(EvdevReading& reading) noexcept { return readings_.take(reading); }
    void command(const std::array<double, 2>& shares) noexcept; // of the force that it can do, each -1 .. 1
    EvdevPhase phase() const noexcept { return phase_.load(std::memory_order_acquire); }
    bool force_was_dropped() noexcept { return dropped_.exchange(false, std::memory_order_acq_rel); }
    void halt() noexcept { halted_.store(true, std::memory_order_release); } // zero force for good

    std::string state() const; // in words. Any thread but the servo's

private:
    struct Command {
        std::array<double, 2> shares{};
        int64_t time_ns = 0;
    };
    struct Axis {
        AxisRange range;
        double sign = 0; // of a level that pushes towards greater values; 0: not known
        double sent = 0, value = 0;
    };

    void run();
    bool connect(int64_t& absent_since_ns);              // false: there is no use in going on
    int serve(InputPort& port);                          // until it fails or the driver ends: errno
    int come_to_rest(InputPort& port, const Axis& axis); // for as long as a nudge lasts
    int nudge(InputPort& port, Axis& axis, int number);
    int send(InputPort& port, int number, double level);
    int listen(InputPort& port, int timeout_ms);
    int keep_forces(InputPort& port);
    void publish() noexcept;
    void enter(EvdevPhase phase, std::string state);
    bool quitting() const noexcept { return quit_.load(std::memory_order_acquire); }
    void pause(int ms) const;

    OpenInput open_;
    EvdevTimes times_;
    Newest<Command> commands_;
    Newest<EvdevReading> readings_;
    std::atomic<EvdevPhase> phase_{EvdevPhase::connecting};
    std::atomic<bool> quit_{false}, halted_{false}, dropped_{false};
    mutable std::mutex state_mutex_;
    std::string state_ = "connecting";

    // The driver's thread alone.
    std::array<Axis, 2> axes_;
    int count_ = 0; // of axes
    Command command_;
    uint32_t session_ = 0;
    std::vector<AxisEvent> events_;
    std::thread thread_; // last: starts when all else is there
};

} // namespace haptel::device
