// A hand that goes round, at 1 kHz by the clock, and whether the motors did what each tick asked of them. For tests
// over the real libusb.
#pragma once

#include "device/falcon/falcon_device.h"
#include "runtime/servo/real_time.h"
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/falcon/falcon_truth.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace haptel::device {

struct Exchange {
    double ticks = 0, poses = 0, sent = 0, replies = 0, skipped = 0, late = 0, malformed = 0;
    double seconds = 0;
    double worst_counts = 0; // by which a command that the device heard is off the nearest that was written, in order
};

inline std::string in_words(const Exchange& done)
{
    std::ostringstream text;
    text << done.ticks << " ticks in " << done.seconds << " s, poses " << done.poses << ", packets " << done.sent
         << ", answered " << 100 * done.replies / done.sent << " %, that is " << 100 * done.replies / done.ticks
         << " % of the ticks, skipped " << done.skipped << ", late " << done.late << ", malformed " << done.malformed
         << "; forces off by at most " << done.worst_counts << " counts";
    return text.str();
}

inline Exchange exchange(FalconDevice& device, FakeFalcon& falcon, double seconds)
{
    using Clock = std::chrono::steady_clock;
    struct Tick {
        glm::dvec3 force_n, place_m;
    };
    std::vector<Tick> asked;
    asked.reserve(static_cast<std::size_t>(1100 * seconds));
    Exchange done;
    const FalconCounters before = device.counters();
    const uint64_t packets_before = falcon.packets(), late_before = device.late();
    const auto start = Clock::now();
    const auto passed_s = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::thread servo([&] {
        runtime::ask_for_real_time(); // as the runtime's does
        for (auto next = start; passed_s() < seconds; ++done.ticks) {
            next = std::max(next + std::chrono::milliseconds(1), Clock::now() - std::chrono::milliseconds(1));
            std::this_thread::sleep_until(next);
            const double t = 1e-3 * done.ticks;
            falcon.set_encoders(
                encoders_at({0.02 * std::sin(2 * t), 0.02 * std::cos(2 * t), 0.125 + 0.01 * std::sin(t)}));
            runtime::DevicePose pose;
            const bool ok = device.read(pose) == runtime::DeviceStatus::ok;
            const glm::dvec3 force_n = 2.0 * glm::dvec3(std::sin(3 * t), std::cos(5 * t), 1);
            device.write(force_n, glm::dvec3(0));
            if (ok)
                asked.push_back(
                    {{force_n.x, force_n.z, -force_n.y}, {pose.tip_m.x, pose.tip_m.z, 0.125 - pose.tip_m.y}});
        }
    });
    servo.join();
    done.seconds = passed_s();
    std::this_thread::sleep_for(std::chrono::milliseconds(10)); // what is on its way
    const FalconCounters after = device.counters();
    done.poses = static_cast<double>(asked.size());
    done.sent = static_cast<double>(falcon.packets() - packets_before);
    done.replies = static_cast<double>(after.replies - before.replies);
    done.skipped = static_cast<double>(after.skipped - before.skipped);
    done.malformed = static_cast<double>(after.malformed - before.malformed);
    done.late = static_cast<double>(device.late() - late_before);

    std::vector<glm::dvec3> written;
    for (const Tick& tick : asked) written.push_back(expected_counts(tick.force_n, tick.place_m));
    std::size_t at = 0;
    const auto commands = falcon.commands();
    for (std::size_t i = packets_before; i < commands.size(); ++i) {
        const glm::dvec3 heard(commands[i][0], commands[i][1], commands[i][2]);
        if (heard == glm::dvec3(0)) continue;
        double nearest = 1e9;
        for (std::size_t j = at; j < written.size() && nearest > 1; ++j) {
            const glm::dvec3 apart = glm::abs(written[j] - heard);
            const double largest = std::max({apart.x, apart.y, apart.z});
            if (largest < nearest) nearest = largest, at = j;
        }
        done.worst_counts = std::max(done.worst_counts, nearest);
    }
    return done;
}

} // namespace haptel::device
