// Forces along x that come and go, at 1 kHz by the clock, on a board whose wheel is held, and whether it heard them.
// For tests over the real libusb and the real kernel.
#pragma once

#include "runtime/hand/haptic_device.h"
#include "tests/device/hid/fake_board.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace haptel::device {

struct BoardExchange {
    double ticks = 0, poses = 0, forces = 0, seconds = 0;
    int worst_counts = 0; // by which a magnitude that it heard is off the nearest that was written, in order
};

inline std::string in_words(const BoardExchange& done)
{
    std::ostringstream text;
    text << done.ticks << " ticks in " << done.seconds << " s, poses " << done.poses << ", forces "
         << done.forces / done.seconds << " a second, off by at most " << done.worst_counts << " counts";
    return text.str();
}

inline int worst_off(const std::vector<int>& heard, std::size_t from, const std::vector<double>& written)
{
    double worst = 0;
    std::size_t at = 0;
    for (std::size_t i = from; i < heard.size(); ++i) {
        if (heard[i] == 0) continue; // the servo was silent
        double nearest = 1e9;
        for (std::size_t j = at; j < written.size() && nearest > 1; ++j) {
            const double off = std::fabs(std::fabs(written[j]) - std::abs(heard[i]));
            if (off < nearest) nearest = off, at = j;
        }
        worst = std::max(worst, nearest);
    }
    return static_cast<int>(std::ceil(worst));
}

inline BoardExchange exchange(runtime::HapticDevice& device, FakeBoard& board, double force_max_n, double seconds)
{
    using Clock = std::chrono::steady_clock;
    board.hold(0, true);
    const uint64_t forces_before = board.forces();
    const std::size_t heard_before = board.heard(0).size();
    std::vector<double> written;
    BoardExchange done;
    const auto start = Clock::now();
    const auto passed_s = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    for (auto next = start; passed_s() < seconds; ++done.ticks) {
        next = std::max(next + std::chrono::milliseconds(1), Clock::now() - std::chrono::milliseconds(1));
        std::this_thread::sleep_until(next);
        runtime::DevicePose pose;
        done.poses += device.read(pose) == runtime::DeviceStatus::ok;
        const double share = std::sin(0.01 * done.ticks);
        written.push_back(32767 * share);
        device.write({force_max_n * share, 0, 0}, glm::dvec3(0));
    }
    done.seconds = passed_s();
    done.forces = static_cast<double>(board.forces() - forces_before);
    done.worst_counts = worst_off(board.heard(0), heard_before, written);
    return done;
}

} // namespace haptel::device
