// A wheel or a stick in memory, as the kernel would show it: motors that push a mass with friction, either way round.
#pragma once

#include "device/evdev/input_port.h"

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace haptel::device {

class FakeWheel {
public:
    struct Axis {
        double sign = 1;      // of the motor: which way a positive level pushes
        bool is_held = false; // by a hand that does not give way
        double place = 0;     // -0.5 .. 0.5
        double speed = 0;     // per second
        double level = 0;     // as set last
        bool is_played = false;
        int told = 0; // value of the last event
    };

    explicit FakeWheel(int axis_count) : count(axis_count) {}
    OpenedInput open(); // fails while it is unplugged

    // For the test's thread.
    double level(int axis);
    double place(int axis);
    void hold(int axis, bool held);
    void turn_to(int axis, double place);
    uint64_t calls() const { return calls_.load(); }
    uint64_t replays() const { return replays_.load(); }

    const int count;
    std::array<Axis, 2> axes;
    std::atomic<bool> is_plugged{true};
    std::atomic<int64_t> fails_at{-1}; // the call of this number, with EIO
    std::atomic<int64_t> fails_for{1}; // and those after it, so many in all
    std::atomic<int> ports{0};         // open ones
    static constexpr int value_max = 32767;

private:
    class Port;
    int call(); // errno
    void advance(double seconds);

    std::mutex mutex_;
    std::atomic<uint64_t> calls_{0}, replays_{0};
};

} // namespace haptel::device
