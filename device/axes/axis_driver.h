// The thread that serves a wheel or a stick: finds out which way its motors push, hands over its newest place, keeps
// the newest force on it, and opens it anew when it was unplugged.
//
// Which way a positive level pushes differs between makes, and a wrong sign throws the wheel away from the hand. So
// each axis is nudged before the first force: from rest, with more and more of its force, for a moment, until it moves.
// One that does not move is held fast or has no motor; it has no force until it does.
#pragma once

#include "device/axes/axis_port.h"
#include "device/usb/newest.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace haptel::device {

using OpenAxes = std::function<OpenedAxes()>;

struct AxisTimes {
    int watchdog_ms = 3; // without a command for so long, the force is taken away
    int nudge_ms = 120;  // each, and the rest before it
    int again_ms = 500;  // between two tries to open or to nudge
    double patience_s = 60;
};

enum class AxisPhase : uint8_t { connecting, nudging, held, running, disconnected, failed };

// Shares of the way from one end of the axis to the other, 0 in the middle: -0.5 .. 0.5.
struct AxisReading {
    std::array<double, axes_max> place{};
    uint32_t session = 0; // counts from 1 on: another one after each opening
};

class AxisDriver final : private AxisClient {
public:
    AxisDriver(OpenAxes open, const AxisTimes& times);
    ~AxisDriver() override; // zero force; comes back within a second
    AxisDriver(const AxisDriver&) = delete;
    AxisDriver& operator=(const AxisDriver&) = delete;

    // The servo's thread: nothing of this allocates, locks or waits.
    bool newest(AxisReading& reading) noexcept { return readings_.take(reading); }
    void command(const AxisLevels& shares) noexcept; // towards greater values
    AxisPhase phase() const noexcept { return phase_.load(std::memory_order_acquire); }
    bool force_was_dropped() noexcept { return dropped_.exchange(false, std::memory_order_acq_rel); }
    void halt() noexcept; // zero force for good

    std::string state() const; // in words. Any thread but the servo's

private:
    struct Command {
        AxisLevels shares{};
        int64_t time_ns = 0;
    };
    struct Axis {
        AxisRange range;
        double sign = 0; // of a level that pushes towards greater values; 0: not known
    };
    // Of the axis whose sign is looked for.
    struct Nudge {
        std::size_t number = 0; // of nudges so far
        bool pushing = false;
        std::optional<int64_t> start = {}; // value that it has moved from
        int64_t since_ns = 0;              // when the push began, or when it was last seen to move
        int64_t not_before_ns = 0;
    };

    void moved(int axis, int64_t value) noexcept override;
    AxisLevels levels() noexcept override;
    bool wants_more() noexcept override { return !quitting(); }
    void was_silenced() noexcept override;

    void run();
    bool connect(); // false: there is no use in going on
    void begin(const AxisPort& port);
    double nudge(Axis& axis, int64_t now_ns) noexcept; // the level for it now
    void publish() noexcept;
    void enter(AxisPhase phase, std::string why);
    bool quitting() const noexcept { return quit_.load(std::memory_order_acquire); }
    void pause(int ms) const;

    OpenAxes open_;
    AxisTimes times_;
    WakeEvent wake_;
    Newest<Command> commands_;
    Newest<AxisReading> readings_;
    std::atomic<AxisPhase> phase_{AxisPhase::connecting};
    std::atomic<bool> quit_{false}, halted_{false}, dropped_{false};
    mutable std::mutex why_mutex_;
    std::string why_ = "connecting"; // why it does not run

    // The driver's thread alone.
    std::array<Axis, axes_max> axes_;
    std::size_t count_ = 0; // of axes
    Nudge nudge_;
    Command command_;
    bool runs_ = false;
    uint32_t session_ = 0;
    int64_t failing_since_ns_ = 0; // 0: it is there and ran
    std::thread thread_;           // last: starts when all else is there
};

} // namespace haptel::device
